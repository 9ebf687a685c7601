/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_reference.h"

#include <math.h>

#include "base/file.h"
#include "base/units.h"
#include "import/set/import_join.h"
#include "import/set/import_rows.h"

static bool is_helper(const ImportTable *table)
{
    return table->source == IMPORT_DARK || table->source == IMPORT_REFERENCE;
}

static bool same_light(const ImportTable *a, const ImportTable *b)
{
    return fabs(a->incidence_deg - b->incidence_deg) < SAME_ANGLE_DEG;
}

/* The helper for a table: of its own light if there is one, else one for every light. */
static bool find_helper(const ImportSet *set, const ImportTable *table, ImportSource source,
                        const ImportTable **out, Error *err)
{
    const ImportTable *found[2] = {NULL, NULL};
    for (int i = 0; i < set->count; i++) {
        const ImportTable *one = &set->table[i];
        if (one->source != source || !import_same_channels(one, table)) continue;
        bool any = source == IMPORT_DARK || one->is_any_light;
        if (!any && !same_light(one, table)) continue;
        if (found[any])
            return error_at(err, ERROR_INPUT, one->file, "", "and %s are both the %s of %s",
                            found[any]->file, import_source_name(source), table->file);
        found[any] = one;
    }
    *out = found[0] ? found[0] : found[1];
    return true;
}

typedef void Combine(double *value, double with, double scale);

static void subtract(double *value, double with, double scale)
{
    *value -= with * scale;
}

/* A reference that reads nothing there gives no number. */
static void divide(double *value, double with, double scale)
{
    *value = with > 0 ? *value / with * scale : NAN;
}

/* A single reading of the helper serves every direction. */
static int *helper_rows(ImportSet *set, const ImportTable *table, const ImportTable *helper)
{
    if (helper->rows > 1) return import_match_rows(table, helper, set->arena);
    import_note(set, "%s is one reading: it serves every direction", path_name(helper->file));
    return ARENA_NEW(set->arena, int, table->rows);
}

/* Combines every row with the helper's row of the same direction; rows without one are left
 * out and counted. */
static bool combine(ImportSet *set, ImportTable *table, const ImportTable *helper,
                    Combine *how, double scale, Error *err)
{
    size_t     size = (size_t)table->channels;
    int       *match = helper_rows(set, table, helper);
    ImportRows kept = import_rows(set->arena, table->rows, 0, table->channels);
    for (int i = 0; i < table->rows; i++) {
        double *row = import_rows_next(&kept);
        bool    is_finite = match[i] >= 0;
        for (size_t c = 0; c < size && is_finite; c++) {
            row[c] = table->value[(size_t)i * size + c];
            how(&row[c], helper->value[(size_t)match[i] * size + c], scale);
            is_finite = isfinite(row[c]);
        }
        if (is_finite) import_rows_end(&kept, table->theta_deg[i], table->phi_deg[i]);
    }
    if (kept.rows < table->rows)
        import_note(set, "%s: %d of %d directions are not in %s and are left out",
                    path_name(table->file), table->rows - kept.rows, table->rows,
                    path_name(helper->file));
    if (!kept.rows)
        return error_at(err, ERROR_INPUT, helper->file, "", "has none of the directions of %s",
                        table->file);
    import_rows_give_measured(&kept, table);
    return true;
}

static bool subtract_dark(ImportSet *set, ImportTable *table, Error *err)
{
    const ImportTable *dark;
    if (!find_helper(set, table, IMPORT_DARK, &dark, err)) return false;
    return !dark || combine(set, table, dark, subtract, 1, err);
}

/* BRDF of a Lambertian reference of reflectance R: R/pi; the signals' ratio carries it over. */
static bool divide_reference(ImportSet *set, ImportTable *table, Error *err)
{
    const ImportTable *reference;
    if (!find_helper(set, table, IMPORT_REFERENCE, &reference, err)) return false;
    if (!reference)
        return error_at(err, ERROR_INPUT, table->file, "",
                        "holds signals, and no white reference was measured at incidence %g "
                        "with the same channels — name one with --role FILE=reference:%g, or "
                        "one for all with --role FILE=reference",
                        table->incidence_deg, table->incidence_deg);
    table->is_signal = false;
    return combine(set, table, reference, divide, set->white_reflectance / PI, err);
}

static bool is_used(const ImportSet *set, const ImportTable *helper)
{
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (!is_helper(table) && import_same_channels(table, helper) &&
            (helper->source == IMPORT_DARK || helper->is_any_light ||
             same_light(table, helper)))
            return true;
    }
    return false;
}

bool import_apply_references(ImportSet *set, Error *err)
{
    for (int i = 0; i < set->count; i++)
        if (is_helper(&set->table[i]) && !is_used(set, &set->table[i]))
            return error_at(err, ERROR_INPUT, set->table[i].file, "",
                            "is a %s file, and no table has its channels%s",
                            import_source_name(set->table[i].source),
                            set->table[i].source == IMPORT_REFERENCE ? " and its light" : "");
    for (int i = 0; i < set->count; i++) /* references too lose their dark signal */
        if (set->table[i].source != IMPORT_DARK && !subtract_dark(set, &set->table[i], err))
            return false;
    for (int i = 0; i < set->count; i++)
        if (set->table[i].is_signal && set->table[i].source == IMPORT_REFLECTION &&
            !divide_reference(set, &set->table[i], err))
            return false;
    import_remove_source(set, IMPORT_DARK);
    import_remove_source(set, IMPORT_REFERENCE);
    return true;
}
