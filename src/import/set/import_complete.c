/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_complete.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "import/set/import.h"
#include "import/set/import_join.h"
#include "import/set/import_lights.h"
#include "import/set/import_rows.h"
#include "panel/set/measurement.h"
#include "panel/set/primary_spectra.h"

/* The panel's spectra begin and end here; the manifest takes no other wavelength. */
#define FIRST_NM 360
#define LAST_NM 830
#define INCIDENCE_MAX_DEG 89

/* ---- what the manifest cannot take ------------------------------------------------------- */

static bool keep_visible(ImportSet *set, ImportTable *table, Error *err) {
    int first = 0, end = table->channels, all = table->channels;
    while (first < end && table->wavelength_nm[first] < FIRST_NM) first++;
    while (end > first && table->wavelength_nm[end - 1] > LAST_NM) end--;
    if (first == end)
        return error_at(err, ERROR_INPUT, table->file, "",
                        "has wavelengths from %g to %g nm, required: some of %d to %d nm",
                        (double)table->wavelength_nm[0], (double)table->wavelength_nm[all - 1],
                        FIRST_NM, LAST_NM);
    if (end - first == all) return true;
    import_note(set, "%d of %d wavelengths lie outside %d to %d nm and are left out",
                all - (end - first), all, FIRST_NM, LAST_NM);
    size_t kept = (size_t)(end - first);
    double *value = ARENA_NEW(set->arena, double, kept *(size_t)table->rows);
    for (size_t i = 0; i < (size_t)table->rows; i++)
        memcpy(value + i * kept, table->value + i * (size_t)all + first, sizeof *value * kept);
    table->value = value;
    table->wavelength_nm += first;
    table->channels = (int)kept;
    return true;
}

static bool keep_usable(ImportSet *set, Error *err) {
    int kept = 0;
    const ImportTable first = set->table[0];
    for (int i = 0; i < set->count; i++) {
        ImportTable *table = &set->table[i];
        bool is_reflection = table->source == IMPORT_REFLECTION;
        if (is_reflection && table->incidence_deg > INCIDENCE_MAX_DEG) {
            import_note(set, "incidence %g degrees is left out: a set goes to %d degrees",
                        table->incidence_deg, INCIDENCE_MAX_DEG);
            continue;
        }
        if (is_reflection && !keep_visible(set, table, err)) return false;
        set->table[kept++] = *table;
    }
    set->count = kept;
    return kept || error_at(err, ERROR_INPUT, first.file, "",
                            "has light from %g degrees and no file from less, required: one "
                            "of 0 to %d degrees",
                            first.incidence_deg, INCIDENCE_MAX_DEG);
}

/* ---- white beside the primaries ---------------------------------------------------------- */

static const ImportTable *full(const ImportSet *set, ImportSource source) {
    const ImportTable *found = NULL;
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source == source && (!found || set->table[i].level > found->level))
            found = &set->table[i];
    return found;
}

/* XYZ of the innermost directions, the mean of them. */
static void inner_xyz(const ImportTable *table, double xyz[3]) {
    double least = 90;
    int rows = 0;
    for (int i = 0; i < table->rows; i++) least = fmin(least, table->theta_deg[i]);
    xyz[0] = xyz[1] = xyz[2] = 0;
    for (int i = 0; i < table->rows; i++) {
        if (table->theta_deg[i] > least + SAME_ANGLE_DEG) continue;
        for (int j = 0; j < 3; j++) xyz[j] += table->value[3 * i + j];
        rows++;
    }
    for (int j = 0; j < 3; j++) xyz[j] /= rows;
}

/* Spectra have the colours that were measured of the same primaries, where these have light. */
static bool check_spectra(const ImportSet *set, Error *err) {
    PrimaryColours colours = {.file = set->spectra.file};
    const ImportTable *black = full(set, IMPORT_BLACK);
    double dark[3] = {0, 0, 0};
    bool is_told = set->spectra.rows > 0 && full(set, IMPORT_RED);
    if (is_told && black) inner_xyz(black, dark);
    for (int p = 0; p < 3 && is_told; p++) {
        import_spectrum_xyz(&set->spectra, p, colours.spectrum[p]);
        inner_xyz(full(set, (ImportSource)p), colours.table[p]);
        for (int j = 0; j < 3; j++) colours.table[p][j] = fmax(0, colours.table[p][j] - dark[j]);
        is_told = colours.table[p][1] > 0;
    }
    return !is_told || primary_colours_check(&colours, err);
}

/* Along the normal, for the verdict. */
static void keep_white(ImportSet *set, const ImportTable *white, const ImportTable *const part[4]) {
    double xyz[3], one[3], sum[3] = {0, 0, 0};
    inner_xyz(white, xyz);
    for (int p = 0; p < 4; p++) {
        inner_xyz(part[p], one);
        for (int j = 0; j < 3; j++) sum[j] += (p < 3 ? 1 : -2) * one[j];
    }
    if (!(xyz[1] > 0) || !(sum[1] > 0)) return;
    set->white_apart[0] = twice_share(xyz[1], sum[1]);
    set->white_apart[1] = twice_colour(xyz, sum);
}

/* Notes by how much a measured white differs from the sum of the primaries. */
static void note_white(ImportSet *set) {
    const ImportTable *white = full(set, IMPORT_WHITE);
    double worst = 0, at[2] = {0, 0}, normal = NAN;
    const ImportTable *part[4];
    int *match[4], compared = 0;
    for (int p = 0; p < 4; p++) {
        part[p] = full(set, p < 3 ? (ImportSource)p : IMPORT_BLACK);
        if (!white || !part[p] || (p < 3 && part[p]->level != 255)) return;
        match[p] = import_match_rows(white, part[p], set->arena);
    }
    for (int i = 0; i < white->rows; i++) {
        double sum = 0, luminance = white->value[3 * i + 1];
        bool all = luminance > 0;
        for (int p = 0; p < 4 && all; p++) {
            all = match[p][i] >= 0;
            if (all) sum += (p < 3 ? 1 : -2) * part[p]->value[3 * match[p][i] + 1];
        }
        if (!all) continue;
        double away = luminance / sum - 1;
        compared++;
        if (white->theta_deg[i] < SAME_ANGLE_DEG && isnan(normal)) normal = away;
        if (fabs(away) <= fabs(worst)) continue;
        worst = away;
        at[0] = white->theta_deg[i];
        at[1] = white->phi_deg[i];
    }
    if (compared) keep_white(set, white, part);
    if (compared)
        import_note(set,
                    "white is %+.2f%% of red + green + blue - 2 black on the normal and "
                    "%+.2f%% at theta %g, phi %g, where it is furthest from the sum",
                    100 * normal, 100 * worst, at[0], at[1]);
}

/* ---- is it a set? ------------------------------------------------------------------------ */

static int count_of(const ImportSet *set, ImportSource source) {
    int count = 0;
    for (int i = 0; i < set->count; i++) count += set->table[i].source == source;
    return count;
}

/* Where the user states that black was subtracted: zeros at the directions of a red table. */
static bool add_zero_black(ImportSet *set, Error *err) {
    ImportTable black = *import_first(set, IMPORT_RED);
    black.source = IMPORT_BLACK;
    black.level = 0;
    black.masked = 0;
    black.masked_theta_deg = black.masked_phi_deg = NULL;
    black.value = ARENA_NEW(set->arena, double, 3 * (size_t)black.rows);
    import_note(set, "the black pattern is declared to be subtracted: it is written as zero");
    return import_add(set, &black, err);
}

/* Primaries with their black, or white alone: what both have too much of is left out. */
static bool check_sources(ImportSet *set, Error *err) {
    bool primaries = import_first(set, IMPORT_RED) || import_first(set, IMPORT_GREEN) ||
                     import_first(set, IMPORT_BLUE);
    bool white = import_first(set, IMPORT_WHITE), black = import_first(set, IMPORT_BLACK);
    if (!primaries && !white && black)
        return error_at(err, ERROR_INPUT, import_first(set, IMPORT_BLACK)->file, "",
                        "is a black pattern alone, required: also red, green and blue, or "
                        "white");
    for (ImportSource p = IMPORT_RED; primaries && p <= IMPORT_BLUE; p++) {
        if (!import_first(set, p))
            return error_set(err, ERROR_INPUT, "no file is %s — name one as --role FILE=%s:LEVEL",
                             import_source_name(p), import_source_name(p));
        if (count_of(set, p) > MEASUREMENT_LEVELS_MAX)
            return error_set(err, ERROR_INPUT, "%s has %d grey levels, required: at most %d",
                             import_source_name(p), count_of(set, p), MEASUREMENT_LEVELS_MAX);
    }
    if (primaries && black && set->black_is_zero)
        return error_at(err, ERROR_INPUT, import_first(set, IMPORT_BLACK)->file, "",
                        "is a black pattern, and --no-black says that there is none");
    if (primaries && !black && set->black_is_zero) return add_zero_black(set, err);
    if (primaries && !black)
        return error_set(err, ERROR_INPUT,
                         "no file is the black pattern — name one as --role "
                         "FILE=black, or say --no-black when it was subtracted");
    if (primaries && white) {
        note_white(set);
        import_note(set, "the white table is not used: red, green and blue are there");
        import_remove_source(set, IMPORT_WHITE);
    }
    if (!primaries && white && black) {
        import_note(set, "the black table is not used: a set of white alone has a black of 0");
        import_remove_source(set, IMPORT_BLACK);
    }
    return true;
}

/* The fit takes noise below zero, but nothing that cannot be noise. */
static bool check_signs(const ImportTable *table, Error *err) {
    bool is_light = table->source == IMPORT_REFLECTION;
    size_t size = (size_t)table->channels, total = size * (size_t)table->rows, worst = 0;
    double most = 0;
    for (size_t i = 0; i < total; i++) {
        most = fmax(most, table->value[i]);
        if (table->value[i] < table->value[worst]) worst = i;
    }
    double share =
        is_light ? (double)ANGLE_TABLE_NOISE_BRDF_SHARE : (double)ANGLE_TABLE_NOISE_CD_M2_SHARE;
    double least = is_light ? (double)ANGLE_TABLE_NOISE_BRDF : (double)ANGLE_TABLE_NOISE_CD_M2;
    double allowed = fmax(least, share * most);
    return table->value[worst] >= -allowed ||
           error_at(err, ERROR_INPUT, table->file, "",
                    "is %g at theta %g, phi %g, required: at least %g %s (noise below zero)",
                    table->value[worst], table->theta_deg[worst / size],
                    table->phi_deg[worst / size], -allowed, is_light ? "sr^-1" : "cd/m2");
}

static int by_light(const void *a, const void *b) {
    const ImportTable *p = a, *q = b;
    if (p->source != q->source) return p->source < q->source ? -1 : 1;
    if (p->level != q->level) return p->level < q->level ? -1 : 1;
    if (p->incidence_phi_deg != q->incidence_phi_deg)
        return p->incidence_phi_deg < q->incidence_phi_deg ? -1 : 1;
    return p->incidence_deg < q->incidence_deg ? -1 : p->incidence_deg > q->incidence_deg;
}

bool import_complete(ImportSet *set, Error *err) {
    if (!set->count) return error_set(err, ERROR_INPUT, "the files hold no table of a panel");
    import_find_anisotropy(set);
    if (!import_join_parts(set, err) || !keep_usable(set, err) ||
        !import_merge_directions(set, err))
        return false;
    if (!import_mirror(set, err) || !import_complete_lights(set, err) || !check_sources(set, err) ||
        !import_check_lights(set, err))
        return false;
    for (int i = 0; i < set->count; i++)
        if (!check_signs(&set->table[i], err)) return false;
    if (!check_spectra(set, err)) return false;
    qsort(set->table, (size_t)set->count, sizeof *set->table, by_light);
    return true;
}
