/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot_data.h"

#include <math.h>

#include "base/file.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_sampling.h"
#include "spectrum/photometry.h"

/* ---- what is chosen --------------------------------------------------------------------- */

#define LARGEST 1e7

/* Reads a number above 0 and moves behind it. */
static bool next_number(const char *option, const char *text, const char **at, double *out,
                        Error *err) {
    const char *after = number_read(*at, out);
    if (!after || !(*out > 0 && *out <= LARGEST))
        return error_set(err, ERROR_USAGE,
                         "%s is '%s', required: numbers above 0 and up to "
                         "1e7 with commas between",
                         option, text);
    *at = after;
    return true;
}

/* True behind a comma; false at the end (*ok) or at anything else. */
static bool goes_on(const char *option, const char *text, const char **at, bool *ok, Error *err) {
    *ok = !**at;
    if (*ok) return false;
    if (**at == ',') {
        (*at)++;
        return true;
    }
    error_set(err, ERROR_USAGE, "%s is '%s': '%s' is no comma and no end", option, text, *at);
    return false;
}

static bool is_full(const char *option, int count, int most, Error *err) {
    if (count < most) return false;
    error_set(err, ERROR_USAGE, "%s has more than %d values", option, most);
    return true;
}

/* has_percent: % may stand behind a value. */
static bool read_list(const char *option, const char *text, int most, bool has_percent,
                      PlotContours *out, Error *err) {
    const char *at = text;
    PlotContours found = {.count = 0};
    bool ok = false;
    do {
        int i = found.count;
        if (is_full(option, i, most, err) || !next_number(option, text, &at, &found.value[i], err))
            return false;
        found.is_percent[i] = has_percent && *at == '%';
        at += found.is_percent[i];
        found.count++;
    } while (goes_on(option, text, &at, &ok, err));
    if (ok) *out = found;
    return ok;
}

bool plot_contours_read(const char *text, PlotContours *out, Error *err) {
    return read_list("--contour", text, PLOT_CONTOURS_MAX, true, out, err);
}

#define DIRECTED_DEG 45.0

bool plot_ambient_read(const char *ambient, const char *directed, PlotAmbient *out, Error *err) {
    PlotContours even = {.count = 0}, beam = {.value = {0, DIRECTED_DEG}};
    if ((ambient && !read_list("--ambient", ambient, PLOT_AMBIENT_MAX, false, &even, err)) ||
        (directed && !read_list("--directed", directed, 2, false, &beam, err)))
        return false;
    if (beam.count < 2) beam.value[1] = DIRECTED_DEG;
    if (directed && !(beam.value[1] < 90))
        return error_set(err, ERROR_USAGE, "--directed is '%s': %g degrees, required: below 90",
                         directed, beam.value[1]);
    if (directed && !ambient) even.count = 1;
    out->count = even.count;
    for (int i = 0; i < even.count; i++)
        out->light[i] = (PlotLight){even.value[i], directed ? beam.value[0] : 0,
                                    radians_from_degrees(beam.value[1])};
    return true;
}

double plot_contours_level(const PlotContours *contours, int i, double on_axis) {
    return contours->is_percent[i] ? contours->value[i] / 100 * on_axis : contours->value[i];
}

const char *plot_kind_name(PlotKind kind) {
    static const char *const NAMES[] = {
        "all",      "luminance",    "contrast",   "colour-shift", "grey-inversion", "grey-levels",
        "sections", "chromaticity", "spectra",    "brdf",         "brdf-spectrum",  "brdf-map",
        "mirror",   "fit",          "uniformity", "halo"};
    return NAMES[kind];
}

#define SIDE 301 /* grid of the maps: 0.6 degrees a step */

const char *pattern_name(Pattern pattern) {
    static const char *const NAMES[] = {"White", "Red", "Green", "Blue", "Black"};
    return NAMES[pattern];
}

const char *pattern_word(Pattern pattern) {
    static const char *const WORDS[] = {"white", "red", "green", "blue", "black"};
    return WORDS[pattern];
}

void pattern_codes(Pattern pattern, float rgb[3]) {
    for (int c = 0; c < 3; c++)
        rgb[c] = pattern == PATTERN_WHITE || (int)pattern == 1 + c ? 255.0f : 0.0f;
}

/* ---- sampling, row by row over the threads ---------------------------------------------- */

static void sample_emission_row(void *context, int item, int worker) {
    PlotData *s = context;
    Pattern pattern = (Pattern)(item / SIDE);
    int row = item % SIDE;
    float rgb[3], xyz[3];
    (void)worker;
    pattern_codes(pattern, rgb);
    for (int column = 0; column < SIDE; column++) {
        Vec3 d = field_direction(&s->xyz[pattern][0], row, column);
        panel_emission_xyz(s->source.panel, d, rgb, xyz);
        for (int c = 0; c < 3; c++) s->xyz[pattern][c].value[row * SIDE + column] = xyz[c];
    }
}

static void sample_emission(PlotData *s) {
    for (int p = 0; p < PATTERN_COUNT; p++) {
        float rgb[3];
        pattern_codes((Pattern)p, rgb);
        panel_emission_xyz(s->source.panel, vec3(0, 0, 1), rgb, s->normal[p]);
        for (int c = 0; c < 3 && s->source.wants_maps; c++)
            s->xyz[p][c] = field_new(SIDE, PI / 2, s->arena);
    }
    if (s->source.wants_maps)
        parallel_for(s->source.threads, PATTERN_COUNT * SIDE, sample_emission_row, s);
    s->has_black = s->normal[PATTERN_BLACK][1] > 0;
    s->cone = panel_info_emission_cone(s->source.panel);
    if (s->cone > radians_from_degrees(89.9)) s->cone = PI / 2;
}

static void look_at_reflection(PlotData *s) {
    s->wavelength_count = panel_info_wavelengths(s->source.panel, s->wavelength_nm);
    double azimuths[PANEL_INFO_AZIMUTHS_MAX];
    s->incidence_count = panel_info_incidences(s->source.panel, s->incidence);
    if (s->incidence_count > 0) s->last_incidence = s->incidence[s->incidence_count - 1];
    s->is_anisotropic = panel_info_azimuths(s->source.panel, azimuths) > 1;
    s->brdf_cone = panel_info_reflection_cone(s->source.panel);
    s->has_mirror = panel_figure_mirror(s->source.panel, radians_from_degrees(5), 0) > 1e-7;
}

/* ---- in even light ---------------------------------------------------------------------- */

#define EVEN_SAMPLES 2048
#define EVEN_AZIMUTHS 8 /* of an anisotropic panel */

/* Base 2 or 3 with its digits mirrored at the point (van der Corput, Halton 1960). */
static float mirrored_digits(int number, int base) {
    double value = 0, digit = 1.0 / base;
    for (; number; number /= base, digit /= base) value += digit * (number % base);
    return (float)fmin(value, 1 - 1e-7);
}

/* The integral of f cos theta_i over the light's hemisphere, by directions drawn as the panel's
 * own sampling has it, so that narrow lobes are met. Luminous mean as brdf's. */
static void sample_even_light(void *context, int item, int worker) {
    PlotData *s = context;
    double theta = radians_from_degrees(item), sum = 0;
    (void)worker;
    for (int i = 0; i < EVEN_SAMPLES; i++) {
        float u[3] = {((float)i + 0.5f) / EVEN_SAMPLES, mirrored_digits(i, 2),
                      mirrored_digits(i, 3)},
              pdf;
        Vec3 wi, wo = panel_figure_direction(
                     theta, s->is_anisotropic ? 2 * PI * (i % EVEN_AZIMUTHS) / EVEN_AZIMUTHS : 0);
        if (!panel_sample(s->source.panel, wo, u, &wi, &pdf)) continue;
        sum += panel_figure_brdf(s->source.panel, wo, wi, 0) * (double)(wi.z / pdf);
    }
    s->diffuse_reflectance[item] = sum / EVEN_SAMPLES;
}

/* emission.azimuths_deg of the file's report: there where most lies between them. */
static const char *few_azimuths(const json_t *emission, Arena *arena) {
    const json_t *list = json_object_get(emission, "azimuths_deg"), *one;
    const char *text = "measured at φ";
    size_t i;
    json_array_foreach(list, i, one) text =
        arena_format(arena, "%s%s %.4g°", text, i ? "," : "", json_number_value(one));
    return json_array_size(list) ? arena_format(arena, "%s alone", text) : NULL;
}

PlotData *plot_data_new(const PlotSource *source, Arena *arena) {
    PlotData *s = ARENA_NEW(arena, PlotData, 1);
    const char *name = json_string_value(json_object_get(source->report, "panel"));
    s->source = *source;
    s->arena = arena;
    s->file_name = arena_printable(arena, path_name(source->file));
    s->name = name && *name ? arena_printable(arena, name) : s->file_name;
    if (source->reading)
        s->file_name = arena_format(arena, "%s, %s", s->file_name, source->reading);
    const json_t *emission = json_object_get(source->report, "emission");
    s->azimuths = few_azimuths(emission, arena);
    s->is_white_only = json_is_true(json_object_get(emission, "white_only"));
    s->has_gamma_table =
        s->is_white_only && json_is_true(json_object_get(emission, "levels_measured"));
    s->emits = panel_info_emits(source->panel);
    s->reflects = panel_reflects(source->panel);
    if (s->emits) sample_emission(s);
    if (s->reflects) look_at_reflection(s);
    if (s->reflects && (source->ambient.count || source->wants_reflectance))
        parallel_for(source->threads, PLOT_REFLECTANCES, sample_even_light, s);
    return s;
}

PanelColour plot_data_normal(const PlotData *data, Pattern pattern) {
    float rgb[3];
    pattern_codes(pattern, rgb);
    return panel_figure_colour(data->source.panel, 0, 0, rgb);
}

Field plot_data_shift(const PlotData *s, Pattern pattern, Arena *arena) {
    Field field = field_new(SIDE, PI / 2, arena);
    double uv[2], xyz[3];
    PanelColour normal = plot_data_normal(s, pattern);
    for (int i = 0; i < SIDE * SIDE; i++) {
        for (int c = 0; c < 3; c++) xyz[c] = (double)s->xyz[pattern][c].value[i];
        uv_from_xyz(xyz, uv);
        field.value[i] = (float)hypot(uv[0] - normal.uv[0], uv[1] - normal.uv[1]);
    }
    return field;
}

/* ---- reflection ------------------------------------------------------------------------- */

static Vec3 light_from(const PlotData *s, double incidence) {
    return panel_figure_direction(incidence, s->source.incidence_phi);
}

/* The azimuth of the panel from one that counts from the mirror direction. */
static double panel_phi(const PlotData *s, double phi) {
    return phi + s->source.incidence_phi - PI;
}

double plot_data_brdf(const PlotData *s, double incidence, double theta, double phi, double nm) {
    return panel_figure_brdf(s->source.panel, panel_figure_direction(theta, panel_phi(s, phi)),
                             light_from(s, incidence), nm);
}

bool plot_data_brdf_is_measured(const PlotData *s, double incidence, double theta, double phi) {
    return panel_brdf_is_measured(s->source.panel, panel_figure_direction(theta, panel_phi(s, phi)),
                                  light_from(s, incidence));
}

const Field *plot_data_brdf_measured(const PlotData *s, double incidence, Arena *arena) {
    Field *field = ARENA_NEW(arena, Field, 1);
    bool is_whole = true;
    *field = field_new(SIDE, PI / 2, arena);
    for (int i = 0; i < SIDE * SIDE; i++) {
        Vec3 d = field_direction(field, i / SIDE, i % SIDE);
        double theta = atan2(hypot((double)d.x, (double)d.y), (double)d.z);
        bool is_measured =
            plot_data_brdf_is_measured(s, incidence, theta, atan2((double)d.y, (double)d.x));
        field->value[i] = is_measured;
        is_whole &= is_measured || theta > s->brdf_cone;
    }
    return is_whole ? NULL : field;
}

typedef struct BrdfWork {
    const PlotData *data;
    Field field;
    double incidence;
} BrdfWork;

static void sample_brdf_row(void *context, int row, int worker) {
    const BrdfWork *work = context;
    double turn = panel_phi(work->data, 0);
    Vec3 light = light_from(work->data, work->incidence);
    (void)worker;
    for (int column = 0; column < work->field.side; column++) {
        Vec3 d = field_direction(&work->field, row, column);
        Vec3 wo = vec3(d.x * (float)cos(turn) - d.y * (float)sin(turn),
                       d.x * (float)sin(turn) + d.y * (float)cos(turn), d.z);
        work->field.value[row * work->field.side + column] =
            (float)panel_figure_brdf(work->data->source.panel, wo, light, 0);
    }
}

Field plot_data_brdf_field(const PlotData *data, double incidence, Arena *arena) {
    BrdfWork work = {data, field_new(SIDE, PI / 2, arena), incidence};
    parallel_for(data->source.threads, SIDE, sample_brdf_row, &work);
    return work.field;
}

/* ---- contrast under diffuse light -------------------------------------------------------- */

PlotLight ambient_light(const PlotData *data, int index) {
    return index ? data->source.ambient.light[index - 1] : (PlotLight){0};
}

double ambient_reflectance(const PlotData *data, double theta) {
    double at = degrees_from_radians(fmin(fmax(theta, 0), PI / 2 - 1e-4));
    int i = (int)at < PLOT_REFLECTANCES - 2 ? (int)at : PLOT_REFLECTANCES - 2;
    const double *diffuse = data->diffuse_reflectance;
    return diffuse[i] + (diffuse[i + 1] - diffuse[i]) * (at - i) +
           panel_figure_mirror(data->source.panel, theta, 0);
}

static double contrast_of(double white, double black, double reflected) {
    return black + reflected > 0 ? (white + reflected) / (black + reflected) : NAN;
}

/* f of the directed source, sr^-1; 0 without one. */
static double directed_brdf(const PlotData *data, Vec3 d, const PlotLight *light) {
    return light->directed_lux > 0 ? panel_figure_brdf(data->source.panel, d,
                                                       light_from(data, light->directed_theta), 0)
                                   : 0;
}

double ambient_reflected(const PlotData *data, double theta, double phi, const PlotLight *light) {
    double even = ambient_reflectance(data, fabs(theta)) * light->lux / PI;
    return even +
           directed_brdf(data, panel_figure_direction(theta, phi), light) * light->directed_lux;
}

double ambient_contrast(const PlotData *data, double theta, double phi, const PlotLight *light) {
    const Panel *panel = data->source.panel;
    return contrast_of(panel_figure_luminance(panel, theta, phi, PANEL_WHITE),
                       panel_figure_luminance(panel, theta, phi, PANEL_BLACK),
                       ambient_reflected(data, theta, phi, light));
}

const char *ambient_text(const PlotLight *light, Arena *arena) {
    if (!(light->directed_lux > 0)) return arena_format(arena, "%.6g lx", light->lux);
    const char *even = light->lux > 0 ? arena_format(arena, "%.6g lx and ", light->lux) : "";
    return arena_format(arena, "%s%.6g lx from %.3g°", even, light->directed_lux,
                        degrees_from_radians(light->directed_theta));
}

/* R at every half degree: it depends on theta alone. */
enum { AMBIENT_STEPS = 181 };

static void fill_reflectance(const PlotData *data, double value[AMBIENT_STEPS]) {
    for (int i = 0; i < AMBIENT_STEPS; i++)
        value[i] =
            ambient_reflectance(data, fmin(i * PI / (2 * (AMBIENT_STEPS - 1)), PI / 2 - 1e-4));
}

static double reflectance_at(const double value[AMBIENT_STEPS], double theta) {
    double at = fmin(fmax(theta / (PI / 2) * (AMBIENT_STEPS - 1), 0), AMBIENT_STEPS - 1);
    int i = at < AMBIENT_STEPS - 2 ? (int)at : AMBIENT_STEPS - 2;
    return value[i] + (value[i + 1] - value[i]) * (at - i);
}

Field ambient_contrast_field(const PlotData *data, const PlotLight *light, Arena *arena) {
    const Field *white = &data->xyz[PATTERN_WHITE][1], *black = &data->xyz[PATTERN_BLACK][1];
    Field field = field_new(white->side, white->theta_rim, arena);
    double reflectance[AMBIENT_STEPS];
    fill_reflectance(data, reflectance);
    for (int i = 0; i < field.side * field.side; i++) {
        Vec3 d = field_direction(&field, i / field.side, i % field.side);
        double theta = atan2(hypot((double)d.x, (double)d.y), (double)d.z);
        double reflected = reflectance_at(reflectance, theta) * light->lux / PI +
                           directed_brdf(data, d, light) * light->directed_lux;
        field.value[i] =
            (float)contrast_of((double)white->value[i], (double)black->value[i], reflected);
    }
    return field;
}
