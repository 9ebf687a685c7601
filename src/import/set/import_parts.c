/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_parts.h"

#include <math.h>
#include <string.h>

#include "import/set/import_join.h"
#include "panel/set/measurement.h"
#include "spectrum/spectral_table.h"

static bool same_light(const ImportTable *a, const ImportTable *b)
{
    if (a->source != b->source) return false;
    if (a->source != IMPORT_REFLECTION) return a->level == b->level;
    return fabs(a->incidence_deg - b->incidence_deg) < SAME_ANGLE_DEG &&
           fabs(a->incidence_phi_deg - b->incidence_phi_deg) < SAME_ANGLE_DEG;
}

/* Sections at several azimuths make one table. */
static bool join_sections(ImportSet *set, Error *err)
{
    int *part = ARENA_NEW(set->arena, int, IMPORT_TABLES_MAX);
    for (int i = 0; i < set->count; i++) {
        int    count = 0;
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
                            "and its other sections have %g directions, wanted at most %d",
                            rows, IMPORT_ROWS_MAX);
        ImportTable joined;
        import_append_tables(set, part, count, &joined);
        set->table[i] = joined;
        import_remove_tables(set, part, count, i);
    }
    return true;
}

/* ---- luminance without colour ------------------------------------------------------------ */

/* X/Y and Z/Y of a spectrum, by the trapezoidal rule over its own wavelengths. */
static bool spectrum_ratios(const ImportSpectra *spectra, const double *value, double ratio[2])
{
    double sum[3] = {0, 0, 0};
    for (int i = 1; i < spectra->rows; i++) {
        double step = spectra->nm[i] - spectra->nm[i - 1];
        for (int k = i - 1; k <= i; k++) {
            int at = (int)lround(spectra->nm[k]) - SPECTRAL_FIRST_NM;
            if (at < 0 || at >= SPECTRAL_COUNT) continue;
            sum[0] += 0.5 * step * value[k] * (double)spectral_table[at].x;
            sum[1] += 0.5 * step * value[k] * (double)spectral_table[at].y;
            sum[2] += 0.5 * step * value[k] * (double)spectral_table[at].z;
        }
    }
    if (!(sum[1] > 0)) return false;
    ratio[0] = sum[0] / sum[1];
    ratio[1] = sum[2] / sum[1];
    return true;
}

/* Luminance alone as X, Y, Z. */
static void add_colour(ImportSet *set, ImportTable *table)
{
    double ratio[2] = {0.95047, 1.08883}; /* D65, CIE 15 */
    bool   measured = table->source <= IMPORT_BLUE && set->spectra.rows &&
                      spectrum_ratios(&set->spectra, set->spectra.value[table->source], ratio);
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
static bool join_components(ImportSet *set, int first, Error *err)
{
    static const char letters[] = "XYZ";
    int          part[3] = {-1, -1, -1};
    ImportTable *table = set->table;
    for (int i = first; i < set->count; i++) {
        if (!table[i].component || !same_light(&table[first], &table[i])) continue;
        int at = (int)(strchr(letters, table[i].component) - letters);
        if (part[at] >= 0)
            return error_at(err, ERROR_INPUT, table[i].file, "", "is %c of %s %g, and so is %s",
                            table[i].component, import_source_name(table[i].source),
                            table[i].level, table[part[at]].file);
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
                            table[first].level, letters[j],
                            import_source_name(table[first].source), table[first].level,
                            letters[j]);
    ImportTable joined = table[first];
    if (!import_join_tables(set, part, 3, &joined, err)) return false;
    joined.component = 0;
    table[first] = joined;
    import_remove_tables(set, part, 3, first);
    return true;
}

static bool join_wavelengths(ImportSet *set, int first, Error *err)
{
    int          part[MEASUREMENT_WAVELENGTHS_MAX], count = 0;
    ImportTable *table = set->table;
    for (int i = first; i < set->count; i++) {
        if (!same_light(&table[first], &table[i])) continue;
        if (count == MEASUREMENT_WAVELENGTHS_MAX)
            return error_at(err, ERROR_INPUT, table[i].file, "", "is one wavelength too many");
        part[count++] = i;
    }
    if (count == 1) return true;
    ImportTable joined = table[first];
    if (!import_join_tables(set, part, count, &joined, err)) return false;
    table[first] = joined;
    import_remove_tables(set, part, count, first);
    return true;
}

static bool refuse_twice(const ImportSet *set, int first, Error *err)
{
    const ImportTable *table = set->table;
    for (int i = first + 1; i < set->count; i++)
        if (same_light(&table[first], &table[i]))
            return error_at(err, ERROR_INPUT, table[i].file, "",
                            "is %s %g, and so is %s — give one of them another --role, or "
                            "leave it out",
                            import_source_name(table[i].source), table[i].level,
                            table[first].file);
    return true;
}

bool import_join_parts(ImportSet *set, Error *err)
{
    if (!join_sections(set, err)) return false;
    for (int i = 0; i < set->count; i++) {
        bool ok = set->table[i].source == IMPORT_REFLECTION ? join_wavelengths(set, i, err)
                  : set->table[i].component ? join_components(set, i, err)
                                            : true;
        if (!ok || !refuse_twice(set, i, err)) return false;
    }
    return true;
}
