/* How well a fitted panel says again what was measured (design: panel, section 8). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "panel/fit_parts.h"

Vec3 fit_row_direction(const AngleTable *table, int row)
{
    double t = (double)table->theta[row], p = (double)table->phi[row];
    return vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
}

/* A row's share of the hemisphere, up to a factor: rings and azimuths are about even. */
double fit_row_weight(const AngleTable *table, int row)
{
    double t = (double)table->theta[row];
    return sin(t > 1e-3 ? t : 1e-3) * cos(t);
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

/* Relative to the sum of the measured tristimulus values, or to 1% of the table's largest sum
 * where the light is dimmer than that. */
static void measure_emission(const AngleTable *table, const Panel *panel, const float rgb[3],
                             FitTable *out)
{
    FitErrors errors = {0};
    double least = 1e-4;
    for (int i = 0; i < table->rows; i++) {
        const float *m = table->value + 3 * i;
        least = fmax(least, 0.01 * (double)(m[0] + m[1] + m[2]));
    }
    for (int i = 0; i < table->rows; i++) {
        const float *m = table->value + 3 * i;
        float  xyz[3];
        Vec3   d = fit_row_direction(table, i);
        double scale = fmax(least, (double)(m[0] + m[1] + m[2]));
        double weight = fit_row_weight(table, i);
        if (!(d.z > 0)) continue;
        panel_emission_xyz(panel, d, rgb, xyz);
        for (int j = 0; j < 3; j++)
            fit_add_error(&errors, (double)xyz[j], (double)m[j], scale, j == 1 ? weight : 0);
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

static void add_emission_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                FitTable *total)
{
    const FitEmission *e = parts->emission;
    int    count = (int)e->head.channels / 3, index = 0;
    double values = (double)e->tree_report.stored_rows * e->head.components / count;
    double bytes = ((double)tree_size(e->tree) + 4.0 * e->head.channels *
                    (1 + e->head.components)) / count;
    for (int p = 0; p < 4; p++) {
        bool is_black = p == 3;
        int  levels = is_black ? (int)e->head.has_black : parts->set->primary[p].level_count;
        for (int i = 0; i < levels; i++, index++) {
            const AngleTable *from = is_black ? &parts->set->black
                                              : &parts->set->primary[p].table[i];
            FitTable one = {.name = from->name, .text_bytes = from->text_bytes,
                            .float32_bytes = 5 * sizeof(float) * (size_t)from->rows,
                            .stored_values = values, .bytes = bytes, .noise = e->noise[index]};
            float rgb[3] = {0, 0, 0};
            if (!is_black) rgb[p] = (float)parts->set->primary[p].level[i];
            measure_emission(from, panel, rgb, &one);
            fit_add_table(tables, total, &one);
        }
    }
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
    add_emission_tables(parts, panel, tables, &total);
    json_t *out = json_pack("{s:s, s:s, s:s, s:s, s:[f,f], s:[f,f], s:s, s:s}",
        "panel", set->panel, "instrument", set->instrument, "note", set->note,
        "source", path_name(set->file), "pixels", set->pixels[0], set->pixels[1],
        "size_mm", set->size_mm[0], set->size_mm[1], "basis", "haar",
        "weights", parts->options->weights == HAAR_AREA ? "area" : "equal");
    json_object_set_new(out, "emission", json_pack("{s:i, s:i, s:f, s:f, s:b, s:b}",
        "level", ((const TreeHeader *)parts->emission->tree)->level,
        "components", (int)parts->emission->head.components,
        "rank_residual", parts->emission->rank_residual,
        "cone_deg", degrees_from_radians(acos((double)panel->emission->cone_cos)),
        "black", (int)parts->emission->head.has_black, "white_only", (int)set->is_white_only));
    char hash[32];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)source_hash(set));
    json_object_set_new(out, "source_hash_xxh3", json_string(hash));
    if (parts->reflection) {
        fit_report_reflection_tables(parts, panel, tables, &total);
        fit_report_reflection(parts, panel, out);
    }
    json_object_set_new(out, "tables", tables);
    json_object_set_new(out, "total", table_json(&total));
    json_object_set_new(out, "notes", notes_json(parts->notes));
    return out;
}
