/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_beside.h"

#include "panel/set/level_table.h"

/* ---- a gamma table ----------------------------------------------------------------------- */

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

bool import_beside_levels(const char *file, double level_max, ImportSet *set, Error *err)
{
    const ImportTable *white = import_first(set, IMPORT_WHITE);
    LevelTable        *levels = ARENA_NEW(set->arena, LevelTable, 1);
    double             theta_deg;
    if (!white)
        return error_at(err, ERROR_INPUT, file, "", "is a level table for a set of white "
                        "alone, but the files to import hold no white pattern alone");
    if (!level_table_read(file, level_max, set->arena, levels, err)) return false;
    double full = white_at_normal(white, &theta_deg);
    if (theta_deg > NORMAL_DEG)
        import_note(set, "white is measured from %.3g degrees on: the level table's full level "
                    "is not compared with it", theta_deg);
    else if (!level_table_check_white(levels, full, white->file, err)) return false;
    import_note(set, "%s", level_table_note(levels, set->arena));
    set->levels = levels;
    return true;
}

/* ---- a mirror's reflectance -------------------------------------------------------------- */

static bool check(const ImportSpecular *asked, const ImportSet *set, Error *err)
{
    if (asked->file && asked->gloss.count)
        return error_set(err, ERROR_USAGE, "both a specular table and gloss are given, "
                                           "required: one of them: the table says more");
    if (!asked->file && asked->aperture_deg > 0)
        return error_set(err, ERROR_USAGE, "the aperture is a specular table's, required: "
                         "one (--specular)");
    return import_first(set, IMPORT_REFLECTION) || (!asked->file && !asked->gloss.count) ||
           error_set(err, ERROR_INPUT, "a specular measurement belongs to a reflection, but "
                     "the files to import hold none");
}

bool import_beside_specular(const ImportSpecular *asked, ImportSet *set, Error *err)
{
    if (!check(asked, set, err)) return false;
    if (asked->gloss.count) {
        set->gloss = &asked->gloss;
        import_note(set, "gloss is taken as the specular reflectance within a round aperture, "
                    "the same at all wavelengths: an approximation");
    }
    if (!asked->file) return true;
    SpecularTable *table = ARENA_NEW(set->arena, SpecularTable, 1);
    if (!specular_table_read_file(asked->file, asked->aperture_deg, set->arena, table, err))
        return false;
    set->specular = table;
    set->specular_aperture_deg = asked->aperture_deg;
    if (!(asked->aperture_deg > 0))
        import_note(set, "the specular table is taken as the mirror alone: no aperture is "
                    "given");
    return true;
}
