/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot_answer.h"

#include <math.h>

#include "base/count.h"
#include "base/units.h"

/* ---- lines ------------------------------------------------------------------------------ */

/* theta and phi in degrees; false outside the disc, where cells hold the rim's values. */
static bool angles_of(const Field *field, ContourPoint point, double degrees[2]) {
    double middle = (field->side - 1) / 2.0, x = point.x - middle, y = middle - point.y;
    double phi = degrees_from_radians(atan2(y, x));
    degrees[0] = degrees_from_radians(hypot(x, y) / middle * field->theta_rim);
    degrees[1] = phi < 0 ? phi + 360 : phi;
    return hypot(x, y) <= middle;
}

static json_t *line_json(const Field *field, const ContourLine *line) {
    json_t *out = json_array();
    double degrees[2];
    for (int i = 0; i < line->count; i++)
        if (angles_of(field, line->point[i], degrees))
            json_array_append_new(out, json_pack("[f,f]", degrees[0], degrees[1]));
    return out;
}

static json_t *lines_json(const Field *field, double level, Arena scratch) {
    ContourSet set = contour_lines(field->value, field->side, level, &scratch);
    json_t *lines = json_array();
    for (int k = 0; k < set.count; k++) {
        json_t *line = line_json(field, &set.line[k]);
        if (json_array_size(line)) json_array_append(lines, line);
        json_decref(line);
    }
    return lines;
}

static void add_contours(json_t *out, const PlotData *s, const char *chart, const Field *field,
                         double on_axis) {
    const PlotContours *wanted = &s->source.contours;
    for (int i = 0; i < wanted->count; i++) {
        double level = plot_contours_level(wanted, i, on_axis);
        json_array_append_new(
            out, json_pack("{s:s, s:f, s:b, s:f, s:o}", "chart", chart, "asked", wanted->value[i],
                           "percent_of_axis", (int)wanted->is_percent[i], "level", level,
                           "lines_theta_phi_deg", lines_json(field, level, *s->arena)));
    }
}

static void add_luminance_contours(json_t *out, const PlotData *s) {
    for (int p = 0; p < PATTERN_COUNT; p++)
        if (s->normal[p][1] > 0)
            add_contours(out, s, arena_format(s->arena, "luminance %s", pattern_word((Pattern)p)),
                         &s->xyz[p][1], (double)s->normal[p][1]);
}

static void add_contrast_contours(json_t *out, const PlotData *s) {
    for (int i = s->has_black ? 0 : 1; i <= s->source.ambient.count; i++) {
        PlotLight light = ambient_light(s, i);
        Field field = ambient_contrast_field(s, &light, s->arena);
        const char *in = i ? arena_format(s->arena, " %s", ambient_text(&light, s->arena)) : "";
        add_contours(out, s, arena_format(s->arena, "contrast%s", in), &field,
                     ambient_contrast(s, 0, 0, &light));
    }
}

static json_t *contours_json(const PlotData *s, PlotKind kind) {
    json_t *out = json_array();
    if (kind != PLOT_CONTRAST) add_luminance_contours(out, s);
    if (kind != PLOT_LUMINANCE) add_contrast_contours(out, s);
    return out;
}

/* ---- contrast in the light -------------------------------------------------------------- */

/* The directions of the tables: the normal once. */
static const struct {
    int theta, phi;
} asked[] = {
    {0, 0},    {15, 0},   {15, 90},  {15, 180}, {15, 270}, {30, 0},   {30, 90},
    {30, 180}, {30, 270}, {45, 0},   {45, 90},  {45, 180}, {45, 270}, {60, 0},
    {60, 90},  {60, 180}, {60, 270}, {75, 0},   {75, 90},  {75, 180}, {75, 270},
};

static json_t *ambient_json(const PlotData *s, const PlotLight *light) {
    json_t *rows = json_array();
    for (int i = 0; i < COUNT_OF(asked); i++) {
        double theta = radians_from_degrees(asked[i].theta);
        double phi = radians_from_degrees(asked[i].phi);
        json_array_append_new(
            rows, json_pack("{s:i, s:i, s:f, s:f, s:f}", "theta_deg", asked[i].theta, "phi_deg",
                            asked[i].phi, "reflectance", ambient_reflectance(s, theta),
                            "reflected_cd_m2", ambient_reflected(s, theta, phi, light), "contrast",
                            ambient_contrast(s, theta, phi, light)));
    }
    json_t *out = json_pack("{s:f, s:s, s:o}", "illuminance_lx", light->lux, "formula",
                            AMBIENT_FORMULA, "angles", rows);
    if (light->directed_lux > 0)
        json_object_update_new(
            out, json_pack("{s:f, s:f, s:f}", "directed_lx", light->directed_lux,
                           "directed_theta_deg", degrees_from_radians(light->directed_theta),
                           "directed_phi_deg", degrees_from_radians(s->source.incidence_phi)));
    return out;
}

void plot_answer_add(const PlotData *data, PlotKind kind, json_t *answer) {
    const PlotAmbient *ambient = &data->source.ambient;
    json_t *list = json_array();
    if (data->source.contours.count && data->emits)
        json_object_set_new(answer, "contours", contours_json(data, kind));
    for (int i = 0; i < ambient->count; i++)
        json_array_append_new(list, ambient_json(data, &ambient->light[i]));
    if (ambient->count) json_object_set(answer, "ambient", list);
    json_decref(list);
}
