/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_levels.h"

#include "panel/set/level_table.h"

#define NORMAL_DEG 10.0 /* white nearer to the normal than this is compared */

/* Mean luminance of the innermost directions, which lie at *theta_deg. */
static double white_at_normal(const ImportTable *white, double *theta_deg)
{
    double sum = 0;
    int    count = 0;
    *theta_deg = 90;
    for (int i = 0; i < white->rows; i++)
        if (white->theta_deg[i] < *theta_deg) *theta_deg = white->theta_deg[i];
    for (int i = 0; i < white->rows; i++) {
        if (white->theta_deg[i] > *theta_deg + SAME_ANGLE_DEG) continue;
        sum += white->value[3 * (size_t)i + 1];
        count++;
    }
    return sum / (count > 0 ? count : 1);
}

bool import_levels(const char *file, ImportSet *set, Error *err)
{
    const ImportTable *white = NULL;
    LevelTable        *levels = ARENA_NEW(set->arena, LevelTable, 1);
    double             theta_deg;
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source == IMPORT_WHITE) white = &set->table[i];
    if (!white)
        return error_at(err, ERROR_INPUT, file, "", "is a level table for a set of white "
                        "alone, but the files to import hold no white pattern alone");
    if (!level_table_read(file, set->arena, levels, err)) return false;
    double full = white_at_normal(white, &theta_deg);
    if (theta_deg > NORMAL_DEG)
        import_note(set, "white is measured from %.3g degrees on: the level table's full level "
                    "is not compared with it", theta_deg);
    else if (!level_table_check_white(levels, full, white->file, err)) return false;
    import_note(set, "%s", level_table_note(levels, set->arena));
    set->levels = levels;
    return true;
}
