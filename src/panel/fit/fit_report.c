/* How well a fitted panel says again what was measured (design: panel, section 8). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "panel/fit/fit_parts.h"

Vec3 fit_row_direction(const AngleTable *table, int row)
{
    double t = (double)table->theta[row], p = (double)table->phi[row];
    return vec3((float)(sin_d(t) * cos_d(p)), (float)(sin_d(t) * sin_d(p)), (float)cos_d(t));
}

/* A row's share of the hemisphere, up to a factor: rings and azimuths are about even. */
double fit_row_weight(const AngleTable *table, int row)
{
    double t = (double)table->theta[row];
    return sin_d(t > 1e-3 ? t : 1e-3) * cos_d(t);
}

void fit_add_error(FitErrors *errors, double found, double wanted, double scale, double weight)
{
    double relative = fabs(found - wanted) / scale;
    errors->max = fmax(errors->max, relative);
    errors->squares += relative * relative;
    errors->count += 1;
    errors->integral += weight * found;
    errors->integral_source += weight * wanted;
    errors->l2 += weight * (found - wanted) * (found - wanted);
    errors->l2_source += weight * wanted * wanted;
}

void fit_finish_errors(const FitErrors *errors, FitTable *out)
{
    out->max_error = errors->max;
    out->rms_error = sqrt(errors->squares / fmax(1, errors->count));
    out->integral_error = errors->integral_source > 0
                              ? errors->integral / errors->integral_source - 1 : 0;
}

/* Relative to the measured value itself, or to 20 times what is noise even without light, or
 * to what no meter sees. */
static void measure_emission(const AngleTable *table, const Panel *panel, const float rgb[3],
                             const double dim[3], const uint8_t *masked, FitTable *out)
{
    FitErrors errors = {0};
    for (int i = 0; i < table->rows; i++) {
        const float *m = table->value + 3 * i;
        float  xyz[3];
        Vec3   d = fit_row_direction(table, i);
        double weight = fit_row_weight(table, i);
        if (!(d.z > 0) || (masked && masked[i])) continue;
        panel_emission_xyz(panel, d, rgb, xyz);
        for (int j = 0; j < 3; j++)
            fit_add_error(&errors, (double)xyz[j], (double)m[j],
                          fmax(fmax(20 * dim[j], FIT_NO_LIGHT), (double)m[j]),
                          j == 1 ? weight : 0);
    }
    fit_finish_errors(&errors, out);
    out->extrapolated = (double)panel->emission->cone_cos; /* share of the hemisphere's sr */
}

static double ratio_of(double bytes, double stored)
{
    return stored > 0 ? bytes / stored : 0;
}

static json_t *table_json(const FitTable *t)
{
    return json_pack("{s:s, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}",
                     "name", t->name, "source_bytes_text", (json_int_t)t->text_bytes,
                     "source_bytes_float32", (json_int_t)t->float32_bytes,
                     "stored_values", t->stored_values, "bytes", t->bytes,
                     "ratio", ratio_of((double)t->float32_bytes, t->bytes),
                     "ratio_text", ratio_of((double)t->text_bytes, t->bytes),
                     "max_error", t->max_error, "rms_error", t->rms_error,
                     "integral_error", t->integral_error, "noise", t->noise,
                     "extrapolated_share", t->extrapolated);
}

void fit_report_size(json_t *total, size_t file_bytes)
{
    double bytes = (double)file_bytes;
    double binary = json_number_value(json_object_get(total, "source_bytes_float32"));
    double text = json_number_value(json_object_get(total, "source_bytes_text"));
    json_object_set_new(total, "bytes", json_real(bytes));
    json_object_set_new(total, "ratio", json_real(ratio_of(binary, bytes)));
    json_object_set_new(total, "ratio_text", json_real(ratio_of(text, bytes)));
}

void fit_add_table(json_t *tables, FitTable *total, const FitTable *one)
{
    json_array_append_new(tables, table_json(one));
    total->text_bytes += one->text_bytes;
    total->float32_bytes += one->float32_bytes;
    total->stored_values += one->stored_values;
    total->max_error = fmax(total->max_error, one->max_error);
    total->rms_error = fmax(total->rms_error, one->rms_error);
    total->integral_error = fmax(total->integral_error, fabs(one->integral_error));
    total->noise = fmax(total->noise, one->noise);
    total->extrapolated = fmax(total->extrapolated, one->extrapolated);
}

static size_t emission_bytes(const FitEmission *e)
{
    return e->section_size + tree_size(e->tree);
}

static const AngleTable *table_at(const FitParts *parts, int index, float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int p = 0; p < 3; p++) {
        const MeasuredPrimary *from = &parts->set->primary[p];
        if (index < from->level_count) {
            rgb[p] = (float)from->level[index];
            return &from->table[index];
        }
        index -= from->level_count;
    }
    return &parts->set->black;
}

static void add_emission_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                FitTable *total)
{
    const FitEmission *e = parts->emission;
    for (int i = 0; i < e->table_count; i++) {
        float rgb[3];
        const AngleTable *from = table_at(parts, i, rgb);
        FitTable one = {.name = from->name, .text_bytes = from->text_bytes,
                        .float32_bytes = parts->set->is_white_only && i
                                             ? 0 : 3 * sizeof(float) * (size_t)from->rows,
                        .stored_values = (double)e->tree_report.stored_values / e->table_count,
                        .bytes = (double)emission_bytes(e) / e->table_count,
                        .noise = e->noise[i]};
        measure_emission(from, panel, rgb, e->dim[i], e->is_masked ? e->outlier[i] : NULL,
                         &one);
        fit_add_table(tables, total, &one);
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

/* What was chosen for the emission, and what it takes. */
static json_t *describe_emission(const FitParts *parts, const FitTable *total, int falling)
{
    const FitEmission *e = parts->emission;
    double bytes = (double)emission_bytes(e);
    return json_pack("{s:s, s:i, s:i, s:f, s:f, s:f, s:f, s:b, s:b, s:I, s:I, s:f, s:i, s:i,"
                     " s:i}",
        "basis", parts->options->basis == FIT_HAAR ? "haar" : "vertex",
        "level", e->level, "components", e->components, "tolerance", e->tolerance,
        "bound", total->max_error, "rank_error", e->rank_worst,
        "cone_deg", degrees_from_radians(e->cone), "black", (int)e->has_black,
        "white_only", (int)parts->set->is_white_only,
        "bytes", (json_int_t)emission_bytes(e),
        "source_bytes_float32", (json_int_t)total->float32_bytes,
        "share_of_source", bytes / fmax(1, (double)total->float32_bytes),
        "outliers", e->outlier_count, "holes", e->hole_count, "falling_codes", falling);
}

static json_t *flags_json(const FitFlags *flags, bool has_values)
{
    json_t *list = json_array();
    for (int i = 0; i < flags->count && i < FIT_FLAGS_MAX; i++) {
        const FitFlag *f = &flags->flag[i];
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

/* Of all measured numbers, so that a panel can be told from another set's of the same name. */
static uint64_t source_hash(const Measurement *set)
{
    XXH3_state_t hash;
    XXH3_64bits_reset(&hash);
    if (set->has_black) hash_table(&hash, &set->black);
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++)
            hash_table(&hash, &set->primary[p].table[i]);
    for (int i = 0; i < set->incidence_count; i++) hash_table(&hash, &set->brdf[i]);
    if (set->has_spectra) XXH3_64bits_update(&hash, set->spectrum, sizeof set->spectrum);
    return XXH3_64bits_digest(&hash);
}

json_t *fit_measure(const FitParts *parts, const Panel *panel, size_t file_bytes)
{
    const Measurement *set = parts->set;
    json_t  *tables = json_array();
    FitTable total = {.name = "total", .bytes = (double)file_bytes};
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
        add_emission_tables(parts, panel, tables, &total);
        int falling = count_falling(panel);
        if (falling)
            fit_note(parts->notes, "%d codes, over directions and primaries, give less light "
                     "than the code below", falling);
        json_object_set_new(out, "emission", describe_emission(parts, &total, falling));
        json_object_set_new(out, "outliers", flags_json(&parts->emission->outliers, true));
        json_object_set_new(out, "holes", flags_json(&parts->emission->holes, false));
    }
    if (parts->reflection) {
        fit_report_reflection_tables(parts, panel, tables, &total);
        fit_report_reflection(parts, panel, out);
    }
    json_object_set_new(out, "tables", tables);
    json_object_set_new(out, "total", table_json(&total));
    json_object_set_new(out, "notes", notes_json(parts->notes));
    return out;
}
