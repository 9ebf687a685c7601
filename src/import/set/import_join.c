/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "import/set/import_rows.h"
#include "panel/set/measurement.h"
#include "spectrum/spectral_table.h"

#define SAME_NM 1e-3f

/* A direction in steps of SAME_ANGLE_DEG, and its row. */
typedef struct RowPlace {
    long theta, phi;
    int row;
} RowPlace;

#define STEPS(degrees) lround((degrees) / SAME_ANGLE_DEG)

static int by_place(const void *a, const void *b) {
    const RowPlace *p = a, *q = b;
    if (p->theta != q->theta) return p->theta < q->theta ? -1 : 1;
    if (p->phi != q->phi) return p->phi < q->phi ? -1 : 1;
    return p->row < q->row ? -1 : p->row > q->row;
}

static bool same_place(const RowPlace *a, const RowPlace *b) {
    return a->theta == b->theta && a->phi == b->phi;
}

static RowPlace *sorted_places(const ImportTable *table, Arena *arena) {
    RowPlace *place = ARENA_NEW(arena, RowPlace, table->rows);
    long turn = STEPS(360.0);
    for (int i = 0; i < table->rows; i++) {
        long phi = STEPS(table->phi_deg[i]) % turn;
        place[i] = (RowPlace){STEPS(table->theta_deg[i]), phi < 0 ? phi + turn : phi, i};
    }
    qsort(place, (size_t)table->rows, sizeof *place, by_place);
    return place;
}

bool import_same_channels(const ImportTable *a, const ImportTable *b) {
    bool same = a->channels == b->channels && a->component == b->component &&
                !a->wavelength_nm == !b->wavelength_nm;
    for (int c = 0; same && a->wavelength_nm && c < a->channels; c++)
        same = fabsf(a->wavelength_nm[c] - b->wavelength_nm[c]) < SAME_NM;
    return same;
}

int *import_match_rows(const ImportTable *table, const ImportTable *other, Arena *arena) {
    int *match = ARENA_NEW(arena, int, table->rows);
    Arena scratch = *arena;
    RowPlace *from = sorted_places(table, &scratch), *to = sorted_places(other, &scratch);
    for (int i = 0, k = 0; i < table->rows; i++) {
        RowPlace wanted = {from[i].theta, from[i].phi, 0};
        while (k < other->rows && by_place(&to[k], &wanted) < 0) k++;
        match[from[i].row] = k < other->rows && same_place(&to[k], &wanted) ? to[k].row : -1;
    }
    return match;
}

/* ---- joining ----------------------------------------------------------------------------- */

static void sort_parts(const ImportSet *set, const int *part, int count, int *sorted) {
    memcpy(sorted, part, sizeof *sorted * (size_t)count);
    if (set->table[part[0]].source != IMPORT_REFLECTION) return;
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && set->table[sorted[k]].wavelength_nm[0] <
                                     set->table[sorted[k - 1]].wavelength_nm[0];
             k--) {
            int swap = sorted[k];
            sorted[k] = sorted[k - 1];
            sorted[k - 1] = swap;
        }
}

static bool join_wavelengths(const ImportSet *set, const int *part, int count, float *nm,
                             Error *err) {
    int filled = 0;
    for (int k = 0; k < count; k++) {
        const ImportTable *table = &set->table[part[k]];
        for (int c = 0; c < table->channels; c++) {
            nm[filled] = table->wavelength_nm[c];
            if (filled && !(nm[filled] > nm[filled - 1]))
                return error_at(err, ERROR_INPUT, table->file, "",
                                "has light from incidence %g, azimuth %g degrees at %g nm, and "
                                "so has %s",
                                table->incidence_deg, table->incidence_phi_deg, (double)nm[filled],
                                set->table[part[k ? k - 1 : 0]].file);
            filled++;
        }
    }
    return true;
}

typedef struct Joiner {
    const ImportSet *set;
    const int *part;
    int count, channels;
    int **match; /* for each part but the first: its row of each row of that one */
} Joiner;

/* False when a part lacks the direction. */
static bool copy_row(const Joiner *join, int first_row, double *value) {
    for (int k = 0; k < join->count; k++) {
        const ImportTable *table = &join->set->table[join->part[k]];
        int row = k ? join->match[k][first_row] : first_row;
        size_t size = (size_t)table->channels;
        if (row < 0) return false;
        memcpy(value, table->value + (size_t)row * size, sizeof *value * size);
        value += size;
    }
    return true;
}

/* `joined` keeps what it holds of directions that were not measured. */
static void join_rows(const Joiner *join, Arena *arena, ImportTable *joined) {
    const ImportTable *first = &join->set->table[join->part[0]];
    ImportRows rows = import_rows(arena, first->rows, 0, join->channels);
    Arena scratch = *arena;
    RowPlace *place = sorted_places(first, &scratch);
    for (int i = 0; i < first->rows; i++) {
        int row = place[i].row;
        if (copy_row(join, row, import_rows_next(&rows)))
            import_rows_end(&rows, first->theta_deg[row], first->phi_deg[row]);
    }
    import_rows_give_measured(&rows, joined);
}

/* The channels of `count` tables (indices into the set) side by side, at the directions that
 * all of them have; by rising wavelength for reflection. */
static bool join_tables(ImportSet *set, const int *part, int count, ImportTable *joined,
                        Error *err) {
    int *sorted = ARENA_NEW(set->arena, int, count), most = 0;
    Joiner join = {
        .set = set, .part = sorted, .count = count, .match = ARENA_NEW(set->arena, int *, count)};
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
                        "and %s share %d of %d directions, required: the same directions in "
                        "the files of one table",
                        joined->file, joined->rows, most);
    if (joined->rows < most)
        import_note(set, "%s: %d directions are not in every file of the table and are left out",
                    path_name(joined->file), most - joined->rows);
    return true;
}

/* The rows of `count` tables one after the other. */
static void append_tables(ImportSet *set, const int *part, int count, ImportTable *joined) {
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

/* Removes the tables of the list but `keep`. */
static void remove_tables(ImportSet *set, const int *part, int count, int keep) {
    int kept = 0;
    for (int i = 0; i < set->count; i++) {
        bool listed = false;
        for (int k = 0; k < count; k++) listed |= part[k] == i && i != keep;
        if (!listed) set->table[kept++] = set->table[i];
    }
    set->count = kept;
}

void import_remove_source(ImportSet *set, ImportSource source) {
    int kept = 0;
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source != source) set->table[kept++] = set->table[i];
    set->count = kept;
}

/* ---- parts of one table: sections -------------------------------------------------------- */

static bool same_light(const ImportTable *a, const ImportTable *b) {
    if (a->source != b->source) return false;
    if (a->source != IMPORT_REFLECTION) return a->level == b->level;
    return fabs(a->incidence_deg - b->incidence_deg) < SAME_ANGLE_DEG &&
           fabs(a->incidence_phi_deg - b->incidence_phi_deg) < SAME_ANGLE_DEG;
}

/* Sections at several azimuths make one table. */
static bool join_sections(ImportSet *set, Error *err) {
    int *part = ARENA_NEW(set->arena, int, IMPORT_TABLES_MAX);
    for (int i = 0; i < set->count; i++) {
        int count = 0;
        double rows = 0;
        for (int k = i; k < set->count && set->table[i].is_section; k++)
            if (set->table[k].is_section && same_light(&set->table[i], &set->table[k]) &&
                import_same_channels(&set->table[i], &set->table[k])) {
                part[count++] = k;
                rows += set->table[k].rows;
            }
        if (count < 2) continue;
        if (rows > IMPORT_ROWS_MAX)
            return error_at(err, ERROR_INPUT, set->table[i].file, "",
                            "and its other sections have %g directions, required: at most %d", rows,
                            IMPORT_ROWS_MAX);
        ImportTable joined;
        append_tables(set, part, count, &joined);
        set->table[i] = joined;
        remove_tables(set, part, count, i);
    }
    return true;
}

/* ---- luminance without colour ------------------------------------------------------------ */

void import_spectrum_xyz(const ImportSpectra *spectra, int p, double xyz[3]) {
    const double *value = spectra->value[p];
    xyz[0] = xyz[1] = xyz[2] = 0;
    for (int i = 1; i < spectra->rows; i++) {
        double step = spectra->nm[i] - spectra->nm[i - 1];
        for (int k = i - 1; k <= i; k++) {
            int at = (int)lround(spectra->nm[k]) - SPECTRAL_FIRST_NM;
            if (at < 0 || at >= SPECTRAL_COUNT) continue;
            xyz[0] += 0.5 * step * value[k] * (double)spectral_table[at].x;
            xyz[1] += 0.5 * step * value[k] * (double)spectral_table[at].y;
            xyz[2] += 0.5 * step * value[k] * (double)spectral_table[at].z;
        }
    }
}

/* Luminance alone as X, Y, Z. */
static void add_colour(ImportSet *set, ImportTable *table) {
    double ratio[2] = {0.95047, 1.08883}, xyz[3] = {0, 0, 0}; /* D65, CIE 15 */
    if (table->source <= IMPORT_BLUE && set->spectra.rows)
        import_spectrum_xyz(&set->spectra, (int)table->source, xyz);
    bool measured = xyz[1] > 0;
    if (measured) ratio[0] = xyz[0] / xyz[1], ratio[1] = xyz[2] / xyz[1];
    double *value = ARENA_NEW(set->arena, double, 3 * (size_t)table->rows);
    for (size_t i = 0; i < (size_t)table->rows; i++) {
        value[3 * i] = ratio[0] * table->value[i];
        value[3 * i + 1] = table->value[i];
        value[3 * i + 2] = ratio[1] * table->value[i];
    }
    table->value = value;
    table->channels = 3;
    table->component = 0;
    import_note(set, measured ? "luminance alone was measured: the colour is that of the "
                                "primaries' spectra at every angle"
                              : "luminance alone was measured: the colour is taken as D65 "
                                "(x 0.3127, y 0.3290) at every angle");
}

/* ---- components and wavelengths ---------------------------------------------------------- */

/* Files of X, Y and Z alone: each of them once. */
static bool join_components(ImportSet *set, int first, Error *err) {
    static const char letters[] = "XYZ";
    int part[3] = {-1, -1, -1};
    ImportTable *table = set->table;
    for (int i = first; i < set->count; i++) {
        if (!table[i].component || !same_light(&table[first], &table[i])) continue;
        int at = (int)(strchr(letters, table[i].component) - letters);
        if (part[at] >= 0)
            return error_at(err, ERROR_INPUT, table[i].file, "", "is %c of %s %g, and so is %s",
                            table[i].component, import_source_name(table[i].source), table[i].level,
                            table[part[at]].file);
        part[at] = i;
    }
    if (part[1] >= 0 && part[0] < 0 && part[2] < 0) {
        add_colour(set, &table[part[1]]);
        return true;
    }
    for (int j = 0; j < 3; j++)
        if (part[j] < 0)
            return error_at(err, ERROR_INPUT, table[first].file, "",
                            "is %c of %s %g, and no file has %c — give the missing file, or "
                            "its role as --role FILE=%s:%g:%c",
                            table[first].component, import_source_name(table[first].source),
                            table[first].level, letters[j], import_source_name(table[first].source),
                            table[first].level, letters[j]);
    ImportTable joined = table[first];
    if (!join_tables(set, part, 3, &joined, err)) return false;
    joined.component = 0;
    table[first] = joined;
    remove_tables(set, part, 3, first);
    return true;
}

static bool join_bands(ImportSet *set, int first, Error *err) {
    int part[MEASUREMENT_WAVELENGTHS_MAX], count = 0;
    ImportTable *table = set->table;
    for (int i = first; i < set->count; i++) {
        if (!same_light(&table[first], &table[i])) continue;
        if (count == MEASUREMENT_WAVELENGTHS_MAX)
            return error_at(err, ERROR_INPUT, table[i].file, "", "is one wavelength too many");
        part[count++] = i;
    }
    if (count == 1) return true;
    ImportTable joined = table[first];
    if (!join_tables(set, part, count, &joined, err)) return false;
    table[first] = joined;
    remove_tables(set, part, count, first);
    return true;
}

static bool refuse_twice(const ImportSet *set, int first, Error *err) {
    const ImportTable *table = set->table;
    for (int i = first + 1; i < set->count; i++)
        if (same_light(&table[first], &table[i]))
            return error_at(err, ERROR_INPUT, table[i].file, "",
                            "is %s %g, and so is %s — give one of them another --role, or "
                            "leave it out",
                            import_source_name(table[i].source), table[i].level, table[first].file);
    return true;
}

bool import_join_parts(ImportSet *set, Error *err) {
    if (!join_sections(set, err)) return false;
    for (int i = 0; i < set->count; i++) {
        bool ok = set->table[i].source == IMPORT_REFLECTION ? join_bands(set, i, err)
                  : set->table[i].component                 ? join_components(set, i, err)
                                                            : true;
        if (!ok || !refuse_twice(set, i, err)) return false;
    }
    return true;
}

/* ---- a direction once -------------------------------------------------------------------- */

/* How many rows are repetitions; leader[row] is the first row of the same direction. */
static int find_repeats(const ImportTable *table, Arena scratch, int *leader) {
    RowPlace *place = sorted_places(table, &scratch);
    int repeats = 0;
    for (int i = 0; i < table->rows; i++) {
        bool again = i && place[i].theta && same_place(&place[i], &place[i - 1]);
        leader[place[i].row] = again ? leader[place[i - 1].row] : place[i].row;
        repeats += again;
    }
    return repeats;
}

static void take_means(ImportTable *table, const int *leader, int rows, Arena *arena) {
    size_t size = (size_t)table->channels;
    ImportRows means = import_rows(arena, rows, 0, table->channels);
    int *place = ARENA_NEW(arena, int, table->rows), *count = ARENA_NEW(arena, int, rows);
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

#define REPEATS_APART 0.1  /* share: runs further apart are not one measurement, */
#define REPEATS_SURE 3     /* where the sum of differences is so many times what noise makes */
#define REPEATS_WORST 0.5  /* share: so far apart no single direction was measured twice */
#define REPEATS_POLES 4    /* rows at theta 0: so many show the fit which of them is wrong */
#define REPEATS_FLOOR 0.05 /* of a channel's largest: what is less is compared with that */

/* What stands again beside what stood first at the same directions. */
typedef struct Repeats {
    int count;
    double ratio; /* of all values that stand again to those that stood first */
    double sure;  /* the sum of the differences over the root of the sum of their squares */
    double worst; /* largest difference of two values of one direction, of the larger */
    int row;      /* that has it */
} Repeats;

static double largest_of(const ImportTable *table, size_t channel) {
    double most = 0;
    for (int i = 0; i < table->rows; i++)
        most = fmax(most, table->value[(size_t)i * (size_t)table->channels + channel]);
    return most;
}

/* Adds channel c of a repetition; returns by how much it is more. */
static double compare_value(double old, double value, double floor, int row, Repeats *out) {
    double apart = fabs(value - old) / fmax(fmax(old, value), floor);
    if (apart > out->worst) {
        out->worst = apart;
        out->row = row;
    }
    return value - old;
}

static void compare_repeats(const ImportTable *table, const int *leader, Arena scratch,
                            Repeats *out) {
    double first = 0, again = 0, squares = 0;
    size_t size = (size_t)table->channels;
    double *floor = ARENA_NEW(&scratch, double, size);
    int pole = -1, poles = 0;
    for (int i = table->rows - 1; i >= 0; i--) {
        if (STEPS(table->theta_deg[i])) continue;
        pole = i;
        poles++;
    }
    for (size_t c = 0; c < size; c++) floor[c] = fmax(1e-30, REPEATS_FLOOR * largest_of(table, c));
    for (int i = 0; i < table->rows; i++) {
        bool is_pole = poles < REPEATS_POLES && !STEPS(table->theta_deg[i]);
        int older = is_pole ? pole : leader[i];
        double apart = 0;
        for (size_t c = 0; c < size && older != i; c++) {
            double old = table->value[(size_t)older * size + c];
            double value = table->value[(size_t)i * size + c];
            first += old;
            again += value;
            apart += compare_value(old, value, floor[c], i, out);
        }
        squares += apart * apart;
    }
    bool is_light = first > 0 && again > 0 && squares > 0;
    out->ratio = is_light ? again / first : 1;
    out->sure = is_light ? fabs(again - first) / sqrt(squares) : 0;
}

/* Noise goes out of the sums; another scale of a second run does not. */
static bool check_repeats(const ImportTable *table, const Repeats *found, Error *err) {
    double apart = 1 - fmin(found->ratio, 1 / found->ratio);
    if (apart > REPEATS_APART && found->sure >= REPEATS_SURE)
        return error_at(err, ERROR_INPUT, table->file, "",
                        "%d directions stand more than once, with %.3g times the light when "
                        "they stand again: required within %g %% — leave one run out, or say "
                        "--accept for their mean",
                        found->count, found->ratio, 100 * REPEATS_APART);
    return found->worst <= REPEATS_WORST ||
           error_at(err, ERROR_INPUT, table->file, "",
                    "theta %g, phi %g stands more than once, and its values are %.3g %% apart: "
                    "required within %g %% (of what is at least %g %% of the table's largest) "
                    "— leave one out, or say --accept for their mean",
                    table->theta_deg[found->row], table->phi_deg[found->row], 100 * found->worst,
                    100 * REPEATS_WORST, 100 * REPEATS_FLOOR);
}

bool import_merge_directions(ImportSet *set, Error *err) {
    int total = 0, tables = 0;
    double most = -1;
    const char *worst = "";
    for (int i = 0; i < set->count; i++) {
        ImportTable *table = &set->table[i];
        int *leader = ARENA_NEW(set->arena, int, table->rows);
        Repeats found = {.count = find_repeats(table, *set->arena, leader)};
        compare_repeats(table, leader, *set->arena, &found);
        if (!set->accepts_repeats && !check_repeats(table, &found, err)) return false;
        if (!found.count) continue;
        if (found.worst > most)
            worst =
                arena_format(set->arena,
                             "%.2g %% (%s, theta %g, phi %g; its second values "
                             "have %.3g times the light)",
                             100 * found.worst, path_name(table->file), table->theta_deg[found.row],
                             table->phi_deg[found.row], found.ratio);
        most = fmax(most, found.worst);
        take_means(table, leader, table->rows - found.count, set->arena);
        total += found.count;
        tables++;
    }
    if (total)
        import_note(set,
                    "%d directions of %d tables stood more than once and disagree by up "
                    "to %s: their mean was taken",
                    total, tables, worst);
    return true;
}
