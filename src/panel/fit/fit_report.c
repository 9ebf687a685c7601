/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/geodesic.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/fit/common/table_noise.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/fit_judge.h"
#include "panel/fit/judge_limits.h"
#include "panel/fit/fit_report_reflection.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_components.h"

/* A table that the emission is held against. */
typedef struct EmissionCheck {
    const EmissionResult *emission;
    const AngleTable     *table;
    int                   index; /* of the table */
    float                 rgb[3];
    double                least[3]; /* errors are relative to no less, cd m^-2 */
    double                noise[3]; /* relative */
    FitErrors             errors;
} EmissionCheck;

/* 20 times what is noise even without light, what no meter sees, or a share of the channel's
 * largest value. */
static void find_least(EmissionCheck *check, Arena scratch)
{
    const AngleTable *table = check->table;
    for (int j = 0; j < 3; j++) {
        const EmissionResult *e = check->emission;
        check->least[j] = fmax(20 * e->dim[check->index][j],
                               emission_samples_floor(table, j, e->outlier[check->index],
                                                      e->floor_share));
        check->noise[j] = table_noise_relative(table, j, scratch);
    }
}

static void add_emission_row(EmissionCheck *check, int i, const float xyz[3])
{
    const EmissionResult *e = check->emission;
    const float *m = check->table->value + 3 * i;
    double weight = table_row_weight(check->table, i);
    bool   is_followed = !e->outlier[check->index][i];
    for (int j = 0; j < 3; j++) {
        double wanted = (double)m[j], scale = fmax(check->least[j], wanted);
        double sigma = hypot_d(check->noise[j] * wanted, e->dim[check->index][j]);
        double miss = (fabs((double)xyz[j] - wanted) - 5 * sigma) / scale;
        fit_table_add_error(&check->errors, (double)xyz[j], wanted, scale, j == 1 ? weight : 0);
        if (is_followed)
            fit_table_add_excess(&check->errors, miss, fmax(e->tolerance, JUDGE_LEAST_BOUND));
    }
}

/* Relative to the measured value itself, or to the least that counts. */
static void measure_emission(EmissionCheck *check, const Panel *panel, FitTable *out)
{
    const EmissionResult *e = check->emission;
    for (int i = 0; i < check->table->rows; i++) {
        float  xyz[3];
        Vec3   d = table_row_direction(check->table, i);
        if (!(d.z > 0) || (e->is_masked && e->outlier[check->index][i])) continue;
        panel_emission_xyz(panel, d, check->rgb, xyz);
        add_emission_row(check, i, xyz);
    }
    fit_table_finish(&check->errors, out);
    out->extrapolated = (double)panel->emission->cone_cos; /* share of the hemisphere's sr */
}

static size_t emission_bytes(const EmissionResult *e)
{
    return e->section_size + tree_size(e->tree.bytes);
}

static void add_emission_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                FitTable *total, FitErrors *all)
{
    const EmissionResult *e = parts->emission;
    for (int i = 0; i < e->table_count; i++) {
        EmissionTable of = emission_samples_table(parts->set, true, i);
        const AngleTable *from = of.table;
        EmissionCheck check = {.emission = e, .table = from, .index = i};
        if (of.primary < 3) check.rgb[of.primary] = of.code;
        find_least(&check, *parts->notes->arena);
        FitTable one = {.name = from->name, .text_bytes = from->text_bytes,
                        .float32_bytes = parts->set->is_white_only && i
                                             ? 0 : 3 * sizeof(float) * (size_t)from->rows,
                        .stored_values = (double)e->tree.report.stored_values / e->table_count,
                        .bytes = (double)emission_bytes(e) / e->table_count,
                        .noise = e->noise[i]};
        measure_emission(&check, panel, &one);
        fit_table_merge(all, &check.errors);
        fit_table_append(tables, total, &one);
    }
}

#define FALLING_LEVEL 3 /* of the directions that are asked */

/* Whole codes that give less light than the code below, over directions and primaries. */
static int count_falling(const Panel *panel)
{
    int count = 0;
    for (uint32_t i = 0; i < geodesic_count(FALLING_LEVEL); i++) {
        Vec3 d = geodesic_center(FALLING_LEVEL, i);
        if (d.z < panel->emission->cone_cos) continue;
        for (int p = 0; p < 3; p++) {
            float rgb[3] = {0, 0, 0}, xyz[3], before[3];
            panel_emission_xyz(panel, d, rgb, before);
            for (int code = 1; code < 256; code++) {
                rgb[p] = (float)code;
                panel_emission_xyz(panel, d, rgb, xyz);
                count += xyz[1] < before[1] * (1 - 1e-6f);
                memcpy(before, xyz, sizeof before);
            }
        }
    }
    return count;
}

/* The emission's parameters, and its size in bytes. */
static json_t *describe_emission(const FitParts *parts, const FitTable *total, int falling)
{
    const EmissionResult *e = parts->emission;
    double bytes = (double)emission_bytes(e);
    return json_pack("{s:s, s:i, s:i, s:f, s:f, s:f, s:f, s:b, s:b, s:b, s:I, s:I, s:f, s:i,"
                     " s:i, s:i, s:f}",
        "basis", parts->options->basis == FIT_HAAR ? "haar" : "vertex",
        "level", e->tree.level, "components", e->components, "tolerance", e->tolerance,
        "bound", total->max_error, "rank_error", e->rank_worst,
        "cone_deg", degrees_from_radians(e->cone), "black", (int)e->has_black,
        "white_only", (int)parts->set->is_white_only,
        "levels_measured", !parts->set->is_white_only || parts->set->levels,
        "bytes", (json_int_t)emission_bytes(e),
        "source_bytes_float32", (json_int_t)total->float32_bytes,
        "share_of_source", bytes / fmax(1, (double)total->float32_bytes),
        "outliers", e->outlier_count, "holes", e->hole_count, "falling_codes", falling,
        "error_floor", e->floor_share);
}

static json_t *flags_json(const EmissionFlags *flags, bool has_values)
{
    json_t *list = json_array();
    for (int i = 0; i < flags->count && i < EMISSION_FLAGS_MAX; i++) {
        const EmissionFlag *f = &flags->flag[i];
        json_t *one = json_pack("{s:s, s:f, s:f}", "table", f->table, "theta_deg",
                                degrees_from_radians(f->theta), "phi_deg",
                                degrees_from_radians(f->phi));
        if (has_values) {
            json_object_set_new(one, "value", json_real(f->value));
            json_object_set_new(one, "expected", json_real(f->expected));
        }
        json_array_append_new(list, one);
    }
    return list;
}

static json_t *notes_json(const FitNotes *notes)
{
    json_t *list = json_array();
    for (int i = 0; i < notes->count; i++)
        json_array_append_new(list, json_string(notes->text[i]));
    return list;
}

static void hash_table(XXH3_state_t *hash, const AngleTable *table)
{
    size_t rows = (size_t)table->rows;
    XXH3_64bits_update(hash, table->theta, sizeof(float) * rows);
    XXH3_64bits_update(hash, table->phi, sizeof(float) * rows);
    XXH3_64bits_update(hash, table->value, sizeof(float) * rows * (size_t)table->channels);
}

/* Distinguishes sets of the same name by what was measured at their first place. */
static uint64_t source_hash(const Measurement *set)
{
    XXH3_state_t hash;
    XXH3_64bits_reset(&hash);
    if (set->has_black) hash_table(&hash, &set->black);
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++)
            hash_table(&hash, &set->primary[p].table[i]);
    for (int i = 0; i < set->incidence_count * set->azimuth_count; i++)
        hash_table(&hash, &set->brdf[i]);
    if (set->has_spectra) XXH3_64bits_update(&hash, set->spectrum, sizeof set->spectrum);
    return XXH3_64bits_digest(&hash);
}

json_t *fit_report_measure(const FitParts *parts, const Panel *panel, size_t file_bytes)
{
    const Measurement *set = parts->set;
    json_t  *tables = json_array();
    FitTable total = {.name = "total", .bytes = (double)file_bytes};
    FitDeviations all = {0};
    char     hash[32];
    json_t  *out = json_pack("{s:s, s:s, s:s, s:s, s:[f,f], s:[f,f], s:s}",
        "panel", set->panel, "instrument", set->instrument, "note", set->note,
        "source", path_name(set->file), "pixels", set->pixels[0], set->pixels[1],
        "size_mm", set->size_mm[0], set->size_mm[1],
        "basis", parts->options->basis == FIT_HAAR ? "haar" : "vertex");
    if (parts->options->basis == FIT_HAAR)
        json_object_set_new(out, "weights", json_string(
            parts->options->weights == HAAR_AREA ? "area" : "equal"));
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)source_hash(set));
    json_object_set_new(out, "source_hash_xxh3", json_string(hash));
    if (parts->emission) {
        add_emission_tables(parts, panel, tables, &total, &all.emission);
        int falling = count_falling(panel);
        if (falling)
            fit_note(parts->notes, "%d codes, over directions and primaries, give less light "
                     "than the code below", falling);
        json_object_set_new(out, "emission", describe_emission(parts, &total, falling));
        json_object_set_new(out, "outliers", flags_json(&parts->emission->outliers, true));
        json_object_set_new(out, "holes", flags_json(&parts->emission->holes, false));
    }
    if (parts->reflection) {
        fit_report_reflection_tables(parts, panel, tables, &total, &all.reflection);
        fit_report_reflection(parts, panel, out);
    }
    if (json_array_size(parts->spots))
        json_object_set(out, "spots", (json_t *)parts->spots);
    json_object_set_new(out, "tables", tables);
    json_object_set_new(out, "total", fit_table_json(&total));
    json_object_set_new(out, "notes", notes_json(parts->notes));
    fit_judge(parts, &all, &total, out);
    return out;
}
