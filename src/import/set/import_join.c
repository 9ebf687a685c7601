/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "import/set/import_rows.h"

#define SAME_NM 1e-3f

/* A direction in steps of SAME_ANGLE_DEG, and its row. */
typedef struct RowPlace {
    long theta, phi;
    int  row;
} RowPlace;

#define STEPS(degrees) lround((degrees) / SAME_ANGLE_DEG)

static int by_place(const void *a, const void *b)
{
    const RowPlace *p = a, *q = b;
    if (p->theta != q->theta) return p->theta < q->theta ? -1 : 1;
    if (p->phi != q->phi) return p->phi < q->phi ? -1 : 1;
    return p->row < q->row ? -1 : p->row > q->row;
}

static bool same_place(const RowPlace *a, const RowPlace *b)
{
    return a->theta == b->theta && a->phi == b->phi;
}

static RowPlace *sorted_places(const ImportTable *table, Arena *arena)
{
    RowPlace *place = ARENA_NEW(arena, RowPlace, table->rows);
    long   turn = STEPS(360.0);
    for (int i = 0; i < table->rows; i++) {
        long phi = STEPS(table->phi_deg[i]) % turn;
        place[i] = (RowPlace){STEPS(table->theta_deg[i]), phi < 0 ? phi + turn : phi, i};
    }
    qsort(place, (size_t)table->rows, sizeof *place, by_place);
    return place;
}

bool import_same_channels(const ImportTable *a, const ImportTable *b)
{
    bool same = a->channels == b->channels && a->component == b->component &&
                !a->wavelength_nm == !b->wavelength_nm;
    for (int c = 0; same && a->wavelength_nm && c < a->channels; c++)
        same = fabsf(a->wavelength_nm[c] - b->wavelength_nm[c]) < SAME_NM;
    return same;
}

int *import_match_rows(const ImportTable *table, const ImportTable *other, Arena *arena)
{
    int   *match = ARENA_NEW(arena, int, table->rows);
    Arena  scratch = *arena;
    RowPlace *from = sorted_places(table, &scratch), *to = sorted_places(other, &scratch);
    for (int i = 0, k = 0; i < table->rows; i++) {
        RowPlace wanted = {from[i].theta, from[i].phi, 0};
        while (k < other->rows && by_place(&to[k], &wanted) < 0) k++;
        match[from[i].row] = k < other->rows && same_place(&to[k], &wanted) ? to[k].row : -1;
    }
    return match;
}

/* ---- joining ----------------------------------------------------------------------------- */

static void sort_parts(const ImportSet *set, const int *part, int count, int *sorted)
{
    memcpy(sorted, part, sizeof *sorted * (size_t)count);
    if (set->table[part[0]].source != IMPORT_REFLECTION) return;
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && set->table[sorted[k]].wavelength_nm[0] <
                                     set->table[sorted[k - 1]].wavelength_nm[0]; k--) {
            int swap = sorted[k];
            sorted[k] = sorted[k - 1];
            sorted[k - 1] = swap;
        }
}

static bool join_wavelengths(const ImportSet *set, const int *part, int count, float *nm,
                             Error *err)
{
    int filled = 0;
    for (int k = 0; k < count; k++) {
        const ImportTable *table = &set->table[part[k]];
        for (int c = 0; c < table->channels; c++) {
            nm[filled] = table->wavelength_nm[c];
            if (filled && !(nm[filled] > nm[filled - 1]))
                return error_at(err, ERROR_INPUT, table->file, "",
                                "has light from incidence %g, azimuth %g degrees at %g nm, and "
                                "so has %s", table->incidence_deg, table->incidence_phi_deg,
                                (double)nm[filled], set->table[part[k ? k - 1 : 0]].file);
            filled++;
        }
    }
    return true;
}

typedef struct Joiner {
    const ImportSet *set;
    const int       *part;
    int              count, channels;
    int            **match; /* for each part but the first: its row of each row of that one */
} Joiner;

/* False when a part lacks the direction. */
static bool copy_row(const Joiner *join, int first_row, double *value)
{
    for (int k = 0; k < join->count; k++) {
        const ImportTable *table = &join->set->table[join->part[k]];
        int    row = k ? join->match[k][first_row] : first_row;
        size_t size = (size_t)table->channels;
        if (row < 0) return false;
        memcpy(value, table->value + (size_t)row * size, sizeof *value * size);
        value += size;
    }
    return true;
}

/* `joined` keeps what it holds of directions that were not measured. */
static void join_rows(const Joiner *join, Arena *arena, ImportTable *joined)
{
    const ImportTable *first = &join->set->table[join->part[0]];
    ImportRows rows = import_rows(arena, first->rows, 0, join->channels);
    Arena      scratch = *arena;
    RowPlace  *place = sorted_places(first, &scratch);
    for (int i = 0; i < first->rows; i++) {
        int row = place[i].row;
        if (copy_row(join, row, import_rows_next(&rows)))
            import_rows_end(&rows, first->theta_deg[row], first->phi_deg[row]);
    }
    import_rows_give_measured(&rows, joined);
}

bool import_join_tables(ImportSet *set, const int *part, int count, ImportTable *joined,
                        Error *err)
{
    int   *sorted = ARENA_NEW(set->arena, int, count), most = 0;
    Joiner join = {.set = set, .part = sorted, .count = count,
                   .match = ARENA_NEW(set->arena, int *, count)};
    sort_parts(set, part, count, sorted);
    *joined = set->table[sorted[0]];
    joined->masked = 0;
    for (int k = 0; k < count; k++) {
        const ImportTable *table = &set->table[sorted[k]];
        if (k) join.match[k] = import_match_rows(&set->table[sorted[0]], table, set->arena);
        join.channels += table->channels;
        most = table->rows > most ? table->rows : most;
        if (table->masked > joined->masked) {
            joined->masked = table->masked;
            joined->masked_theta_deg = table->masked_theta_deg;
            joined->masked_phi_deg = table->masked_phi_deg;
        }
    }
    float *nm = ARENA_NEW(set->arena, float, join.channels);
    if (joined->source == IMPORT_REFLECTION) {
        if (!join_wavelengths(set, sorted, count, nm, err)) return false;
        joined->wavelength_nm = nm;
    }
    join_rows(&join, set->arena, joined);
    if (2 * joined->rows < most)
        return error_at(err, ERROR_INPUT, set->table[sorted[count - 1]].file, "",
                        "and %s share %d of %d directions, wanted the same directions in the "
                        "files of one table", joined->file, joined->rows, most);
    if (joined->rows < most)
        import_note(set,
                    "%s: %d directions are not in every file of the table and are left out",
                    path_name(joined->file), most - joined->rows);
    return true;
}

void import_append_tables(ImportSet *set, const int *part, int count, ImportTable *joined)
{
    int rows = 0, masked = 0;
    for (int k = 0; k < count; k++) {
        rows += set->table[part[k]].rows;
        masked += set->table[part[k]].masked;
    }
    ImportRows all = import_rows(set->arena, rows, masked, set->table[part[0]].channels);
    for (int k = 0; k < count; k++) import_rows_append(&all, &set->table[part[k]]);
    *joined = set->table[part[0]];
    import_rows_give(&all, joined);
}

void import_remove_tables(ImportSet *set, const int *part, int count, int keep)
{
    int kept = 0;
    for (int i = 0; i < set->count; i++) {
        bool listed = false;
        for (int k = 0; k < count; k++) listed |= part[k] == i && i != keep;
        if (!listed) set->table[kept++] = set->table[i];
    }
    set->count = kept;
}

void import_remove_source(ImportSet *set, ImportSource source)
{
    int kept = 0;
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source != source) set->table[kept++] = set->table[i];
    set->count = kept;
}

/* ---- a direction once -------------------------------------------------------------------- */

/* How many rows are repetitions; leader[row] is the first row of the same direction. */
static int find_repeats(const ImportTable *table, Arena scratch, int *leader)
{
    RowPlace *place = sorted_places(table, &scratch);
    int    repeats = 0;
    for (int i = 0; i < table->rows; i++) {
        bool again = i && place[i].theta && same_place(&place[i], &place[i - 1]);
        leader[place[i].row] = again ? leader[place[i - 1].row] : place[i].row;
        repeats += again;
    }
    return repeats;
}

static void take_means(ImportTable *table, const int *leader, int rows, Arena *arena)
{
    size_t     size = (size_t)table->channels;
    ImportRows means = import_rows(arena, rows, 0, table->channels);
    int       *place = ARENA_NEW(arena, int, table->rows), *count = ARENA_NEW(arena, int, rows);
    for (int i = 0; i < table->rows; i++) {
        if (leader[i] == i) {
            place[i] = means.rows;
            import_rows_end(&means, table->theta_deg[i], table->phi_deg[i]);
        }
        int to = place[leader[i]];
        count[to]++;
        for (size_t c = 0; c < size; c++)
            means.value[(size_t)to * size + c] += table->value[(size_t)i * size + c];
    }
    for (int i = 0; i < rows; i++)
        for (size_t c = 0; c < size && count[i] > 1; c++)
            means.value[(size_t)i * size + c] /= count[i];
    import_rows_give_measured(&means, table);
}

void import_merge_directions(ImportSet *set)
{
    int total = 0, tables = 0;
    for (int i = 0; i < set->count; i++) {
        ImportTable *table = &set->table[i];
        Arena before = *set->arena;
        int  *leader = ARENA_NEW(set->arena, int, table->rows);
        int   repeats = find_repeats(table, *set->arena, leader);
        if (repeats) take_means(table, leader, table->rows - repeats, set->arena);
        else *set->arena = before;
        total += repeats;
        tables += repeats > 0;
    }
    if (total)
        import_note(set,
                    "%d directions of %d tables stood more than once: their mean was taken",
                    total, tables);
}
