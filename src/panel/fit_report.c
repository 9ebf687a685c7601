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

typedef struct Errors {
    double max, squares, count, integral, integral_source;
    double l2, l2_source; /* of the values themselves, cosine-weighted */
} Errors;

static Vec3 direction_of(const AngleTable *table, int row)
{
    double t = (double)table->theta[row], p = (double)table->phi[row];
    return vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
}

/* A row's share of the hemisphere, up to a factor: rings and azimuths are about even. */
static double row_weight(const AngleTable *table, int row)
{
    double t = (double)table->theta[row];
    return sin(t > 1e-3 ? t : 1e-3) * cos(t);
}

static void add_error(Errors *errors, double found, double wanted, double scale, double weight)
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

static void finish(const Errors *errors, FitTable *out)
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
    Errors errors = {0};
    double least = 1e-4;
    for (int i = 0; i < table->rows; i++) {
        const float *m = table->value + 3 * i;
        least = fmax(least, 0.01 * (double)(m[0] + m[1] + m[2]));
    }
    for (int i = 0; i < table->rows; i++) {
        const float *m = table->value + 3 * i;
        float  xyz[3];
        Vec3   d = direction_of(table, i);
        double scale = fmax(least, (double)(m[0] + m[1] + m[2])), weight = row_weight(table, i);
        if (!(d.z > 0)) continue;
        panel_emission_xyz(panel, d, rgb, xyz);
        for (int j = 0; j < 3; j++)
            add_error(&errors, (double)xyz[j], (double)m[j], scale, j == 1 ? weight : 0);
    }
    finish(&errors, out);
    out->extrapolated = (double)panel->emission->cone_cos; /* share of the hemisphere's sr */
}

/* 16 of the measured wavelengths from `first` on; the last one repeats. */
static Wavelengths measured_wavelengths(const Measurement *set, int first)
{
    Wavelengths wavelengths = {0};
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        int w = first + i < set->wavelength_count ? first + i : set->wavelength_count - 1;
        wavelengths.nm[i] = set->wavelength_nm[w];
    }
    return wavelengths;
}

/* The haze against the table without the mirror's image, at every stride-th row. */
static Errors reflection_errors(const Measurement *set, int slice, const AngleTable *table,
                                const Panel *panel, int stride)
{
    Errors errors = {0};
    double theta = set->incidence[slice];
    Vec3   wi = vec3((float)-sin(theta), 0, (float)cos(theta));
    for (int first = 0; first < set->wavelength_count; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = measured_wavelengths(set, first);
        int lanes = set->wavelength_count - first;
        for (int i = 0; i < table->rows; i += stride) {
            const float *m = table->value + (size_t)i * (size_t)table->channels + first;
            Spectrum f = panel_brdf(panel, direction_of(table, i), wi, &wavelengths);
            for (int k = 0; k < lanes && k < SPECTRUM_LANES; k++)
                add_error(&errors, (double)f[k], (double)m[k], fmax(1e-4, (double)m[k]),
                          row_weight(table, i));
        }
    }
    return errors;
}

double fit_reflection_error(const Measurement *set, const FitReflection *reflection,
                            const Panel *panel, int stride)
{
    double sum = 0;
    for (int i = 0; i < set->incidence_count; i++) {
        Errors errors = reflection_errors(set, i, &reflection->haze[i], panel, stride);
        sum += errors.l2 / fmax(1e-30, errors.l2_source);
    }
    return sqrt(sum / fmax(1, set->incidence_count));
}

/* rms of |f(i, o) - f(o, i)| / mean over pairs of measured incidences, at 550 nm or next. */
static double reciprocity_defect(const Measurement *set, const Panel *panel)
{
    double squares = 0, count = 0;
    Wavelengths wavelengths = measured_wavelengths(set, set->wavelength_count / 2);
    for (int a = 0; a < set->incidence_count; a++)
        for (int b = 0; b < a; b++)
            for (int p = 0; p < 36; p++) {
                double t = set->incidence[a], u = set->incidence[b], phi = PI * p / 36;
                Vec3   i = vec3((float)-sin(t), 0, (float)cos(t));
                Vec3   o = vec3((float)(sin(u) * cos(phi)), (float)(sin(u) * sin(phi)),
                                (float)cos(u));
                double f = (double)panel_brdf(panel, o, i, &wavelengths)[0];
                double g = (double)panel_brdf(panel, i, o, &wavelengths)[0];
                squares += 4 * (f - g) * (f - g) / ((f + g) * (f + g));
                count++;
            }
    return count > 0 ? sqrt(squares / count) : 0;
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

static void add_table(json_t *tables, FitTable *total, const FitTable *one)
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
            add_table(tables, total, &one);
        }
    }
}

static void add_reflection_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                  FitTable *total)
{
    const FitReflection *r = parts->reflection;
    double sampling = 0;
    for (uint32_t i = 0; i < r->head.slices; i++)
        sampling += (double)sampling_tree_size(r->sampling[i]);
    double bytes = (double)tree_size(r->tree) + sampling;
    double values = (double)r->tree_report.stored_rows * r->head.coefficients * r->head.slices;
    for (int i = 0; i < parts->set->incidence_count; i++) {
        const AngleTable *from = &r->haze[i];
        FitTable one = {.name = from->name, .text_bytes = from->text_bytes,
            .float32_bytes = (size_t)(2 + from->channels) * sizeof(float) * (size_t)from->rows,
            .stored_values = values / parts->set->incidence_count,
            .bytes = bytes / parts->set->incidence_count, .noise = r->noise[i]};
        Errors errors = reflection_errors(parts->set, i, from, panel, 1);
        finish(&errors, &one);
        one.extrapolated = (double)panel->reflection->cone_cos;
        add_table(tables, total, &one);
    }
}

static json_t *mirror_json(const FitParts *parts)
{
    json_t *list = json_array();
    for (int i = 0; i < parts->set->incidence_count; i++)
        json_array_append_new(list, json_pack("{s:f, s:f}", "incidence_deg",
            degrees_from_radians(parts->set->incidence[i]), "luminous_reflectance",
            parts->reflection->mirror_y[i]));
    return list;
}

static json_t *notes_json(const FitNotes *notes)
{
    json_t *list = json_array();
    for (int i = 0; i < notes->count; i++)
        json_array_append_new(list, json_string(notes->text[i]));
    return list;
}

static void describe_reflection(const FitParts *parts, const Panel *panel, json_t *out)
{
    static const char *const kinds[] = {"haar", "cdf53", "cdf97"};
    const FitReflection *r = parts->reflection;
    json_object_set_new(out, "reflection", json_pack(
        "{s:i, s:i, s:i, s:f, s:s, s:s, s:f, s:f, s:o}",
        "level", ((const TreeHeader *)r->tree)->level, "slices", (int)r->head.slices,
        "spectral_coefficients", (int)r->head.coefficients,
        "frame_exponent", (double)r->head.frame_exponent,
        "wavelet", kinds[parts->options->wavelet],
        "incidence_interpolation", r->head.is_cubic ? "cubic over four slices"
                                                    : "linear over two slices",
        "reciprocity_defect", reciprocity_defect(parts->set, panel),
        "largest_albedo", r->largest_albedo, "mirror", mirror_json(parts)));
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
        add_reflection_tables(parts, panel, tables, &total);
        describe_reflection(parts, panel, out);
    }
    json_object_set_new(out, "tables", tables);
    json_object_set_new(out, "total", table_json(&total));
    json_object_set_new(out, "notes", notes_json(parts->notes));
    return out;
}
