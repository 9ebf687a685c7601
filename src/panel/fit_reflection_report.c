/* How well a fitted panel says again what was measured of its reflection. */
#include <math.h>

#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "panel/fit_parts.h"

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
static FitErrors reflection_errors(const Measurement *set, int slice, const AngleTable *table,
                                const Panel *panel, int stride)
{
    FitErrors errors = {0};
    double theta = set->incidence[slice];
    Vec3   wi = vec3((float)-sin(theta), 0, (float)cos(theta));
    for (int first = 0; first < set->wavelength_count; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = measured_wavelengths(set, first);
        int lanes = set->wavelength_count - first;
        for (int i = 0; i < table->rows; i += stride) {
            const float *m = table->value + (size_t)i * (size_t)table->channels + first;
            Spectrum f = panel_brdf(panel, fit_row_direction(table, i), wi, &wavelengths);
            for (int k = 0; k < lanes && k < SPECTRUM_LANES; k++)
                fit_add_error(&errors, (double)f[k], (double)m[k], fmax(1e-4, (double)m[k]),
                          fit_row_weight(table, i));
        }
    }
    return errors;
}

double fit_reflection_error(const Measurement *set, const FitReflection *reflection,
                            const Panel *panel, int stride)
{
    double sum = 0;
    for (int i = 0; i < set->incidence_count; i++) {
        FitErrors errors = reflection_errors(set, i, &reflection->haze[i], panel, stride);
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

void fit_report_reflection_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                   FitTable *total)
{
    const FitReflection *r = parts->reflection;
    double bytes = (double)tree_size(r->tree) + (double)r->sampling_size;
    double values = (double)r->tree_report.stored_rows * r->head.coefficients * r->head.slices;
    for (int i = 0; i < parts->set->incidence_count; i++) {
        const AngleTable *from = &r->haze[i];
        FitTable one = {.name = from->name, .text_bytes = from->text_bytes,
            .float32_bytes = (size_t)(2 + from->channels) * sizeof(float) * (size_t)from->rows,
            .stored_values = values / parts->set->incidence_count,
            .bytes = bytes / parts->set->incidence_count, .noise = r->noise[i]};
        FitErrors errors = reflection_errors(parts->set, i, from, panel, 1);
        fit_finish_errors(&errors, &one);
        one.extrapolated = (double)panel->reflection->cone_cos;
        fit_add_table(tables, total, &one);
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

void fit_report_reflection(const FitParts *parts, const Panel *panel, json_t *out)
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
