/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_report_reflection.h"

#include <math.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/judge_limits.h"
#include "panel/fit/reflection/reflection_model.h"
#include "panel/fit/reflection/reflection_read.h"
#include "panel/query/panel_components.h"
#include "panel/query/panel_reflection.h"

/* The azimuth of a table's mirror direction. */
static double mirror_azimuth(const Measurement *set, int table)
{
    return set->azimuth_count > 1 ? set->azimuth[table / set->incidence_count] - PI : 0;
}

/* A row's direction in the display's frame. */
static Vec3 row_direction(const AngleTable *table, int row, double mirror)
{
    return table_direction((double)table->theta[row], (double)table->phi[row] + mirror);
}

/* One table in the report; values below the least one that zeros are held above do not
 * count. */
typedef struct TableWork {
    const Measurement      *set;
    const ReflectionResult *reflection;
    const Panel            *panel;
    FitErrors              *errors; /* per table */
} TableWork;

static void add_deviation(TableWork *work, int t, int row, double found, double wanted)
{
    const ReflectionResult *r = work->reflection;
    double weight = table_row_weight(&r->parts.kept[t], row);
    double noise = 5 * reflection_parts_noise(&r->parts, t, wanted);
    double miss = fabs(found - wanted) / wanted - noise;
    fit_table_add_error(&work->errors[t], found, wanted, wanted, weight);
    fit_table_add_excess(&work->errors[t], miss, fmax(r->bound, JUDGE_LEAST_BOUND));
}

static void measure_table(void *context, int t, int worker)
{
    TableWork         *work = context;
    const Measurement *set = work->set;
    const AngleTable  *table = &work->reflection->parts.kept[t];
    double least = reflection_read_least(table), mirror = mirror_azimuth(set, t);
    Vec3   wi = reflection_model_light(set, t);
    (void)worker;
    for (int first = 0; first < set->wavelength_count; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = reflection_model_wavelengths(set, first);
        int lanes = set->wavelength_count - first;
        for (int i = 0; i < table->rows; i++) {
            const float *m = table->value + (size_t)i * (size_t)table->channels + first;
            Vec3     wo = row_direction(table, i, mirror);
            Spectrum f = panel_brdf(work->panel, wo, wi, &wavelengths);
            if (!(wo.z > 0)) continue; /* along the panel nothing leaves it */
            for (int k = 0; k < lanes && k < SPECTRUM_LANES; k++)
                if ((double)m[k] >= least)
                    add_deviation(work, t, i, (double)f[k], (double)m[k]);
        }
    }
}

static size_t reflection_bytes(const ReflectionResult *r)
{
    return r->section.size + tree_size(r->tree) + r->sampling_size;
}

void fit_report_reflection_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                  FitTable *total, FitErrors *all)
{
    const ReflectionResult *r = parts->reflection;
    Arena     scratch = *parts->notes->arena;
    TableWork work = {.set = parts->set, .reflection = r, .panel = panel};
    double bytes = (double)reflection_bytes(r) / r->parts.tables;
    double values = (double)r->tree_report.stored_rows * r->components / r->parts.tables;
    work.errors = ARENA_NEW(&scratch, FitErrors, r->parts.tables);
    parallel_for(parts->options->threads, r->parts.tables, measure_table, &work);
    for (int t = 0; t < r->parts.tables; t++) {
        const AngleTable *from = &r->parts.kept[t];
        FitTable one = {.name = from->name, .text_bytes = from->text_bytes,
            .float32_bytes = (size_t)from->channels * sizeof(float) * (size_t)from->rows,
            .stored_values = values, .bytes = bytes, .noise = r->parts.noise[t]};
        fit_table_finish(&work.errors[t], &one);
        fit_table_merge(all, &work.errors[t]);
        one.extrapolated = (double)panel->reflection->cone_cos;
        fit_table_append(tables, total, &one);
    }
}

/* rms of |f(i, o) - f(o, i)| / mean over pairs of measured incidences, at 550 nm or next. */
static double reciprocity_defect(const Measurement *set, const Panel *panel)
{
    double squares = 0, count = 0;
    Wavelengths wavelengths = reflection_model_wavelengths(set, set->wavelength_count / 2);
    for (int a = 0; a < set->incidence_count; a++)
        for (int b = 0; b < a; b++)
            for (int p = 0; p < 36; p++) {
                double t = set->incidence[a], u = set->incidence[b], phi = PI * p / 36;
                Vec3   i = vec3((float)-sin_d(t), 0, (float)cos_d(t));
                Vec3   o = table_direction(u, phi);
                double f = (double)panel_brdf(panel, o, i, &wavelengths)[0];
                double g = (double)panel_brdf(panel, i, o, &wavelengths)[0];
                squares += 4 * (f - g) * (f - g) / ((f + g) * (f + g));
                count++;
            }
    return count > 0 ? sqrt(squares / count) : 0;
}

/* The three parts (and the lobe, where there is one) at every incidence, luminous. */
static json_t *parts_json(const FitParts *parts, const Panel *panel)
{
    const ReflectionResult *r = parts->reflection;
    json_t *list = json_array();
    for (int i = 0; i < parts->set->incidence_count; i++) {
        double theta = parts->set->incidence[i];
        double haze = (double)panel_haze_albedo(panel, (float)cos_d(theta));
        double lambertian = r->section.lambertian_y[i];
        json_t *one = json_pack("{s:f, s:f, s:f, s:f}",
            "incidence_deg", degrees_from_radians(theta), "luminous_reflectance",
            r->parts.mirror_y[i], "haze", fmax(0, haze - lambertian - r->parts.lobe_y[i]),
            "floor", fmin(haze, lambertian));
        if (r->parts.has_lobe) {
            json_object_set_new(one, "lobe", json_real(r->parts.lobe_y[i]));
            json_object_set_new(one, "lobe_fwhm_deg",
                json_real(reflection_parts_fwhm_deg(&r->parts, i)));
        }
        json_array_append_new(list, one);
    }
    return list;
}

/* How it is read; default values are left out. */
static void add_surface(const PanelSurfaceStored *s, json_t *out)
{
    static const char *const frames[] = {"", "slopes", "direction cosines"};
    if (s->frame != PANEL_FRAME_SPECULAR)
        json_object_set_new(out, "frame", json_string(frames[s->frame]));
    if (s->beyond == PANEL_BEYOND_SLOPES) {
        json_object_set_new(out, "beyond", json_string("facets"));
        json_object_set_new(out, "facet_index", json_real((double)s->refractive_index));
        json_object_set_new(out, "facet_alpha", json_pack("[f, f]",
            sqrt((double)s->roughness[0]), sqrt((double)s->roughness[2])));
    }
    if (s->mirror_index > 0)
        json_object_set_new(out, "mirror_index", json_real((double)s->mirror_index));
}

void fit_report_reflection(const FitParts *parts, const Panel *panel, json_t *out)
{
    static const char *const kinds[] = {"haar", "cdf53", "cdf97"};
    const ReflectionResult *r = parts->reflection;
    int last = parts->set->incidence_count - 1;
    json_object_set_new(out, "reflection", json_pack(
        "{s:s, s:i, s:i, s:i, s:i, s:f, s:s, s:s, s:f, s:f, s:I, s:i, s:f, s:f, s:f, s:o}",
        "basis", parts->options->basis == FIT_VERTEX ? "vertex" : "haar", "level", r->level,
        "azimuths", parts->set->azimuth_count, "spectral_coefficients", r->coefficients,
        "components", r->components, "frame_exponent", (double)r->frame_exponent,
        "wavelet", parts->options->has_wavelet ? kinds[parts->options->wavelet] : "principal",
        "incidence_interpolation", parts->options->is_linear_in_incidence
            ? "linear over two slices" : "cubic over four slices",
        "bound", r->bound, "largest_error_over_bound", r->worst,
        "bytes", (json_int_t)reflection_bytes(r), "zeros_masked", r->masked,
        "reciprocity_defect", reciprocity_defect(parts->set, panel),
        "largest_albedo", r->section.largest_albedo,
        "extrapolated_beyond_deg", degrees_from_radians(parts->set->incidence[last]),
        "mirror", parts_json(parts, panel)));
    add_surface(&r->surface, json_object_get(out, "reflection"));
}
