/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot_data.h"

#include <math.h>

#include "base/file.h"
#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_report.h"

const char *pattern_name(Pattern pattern) {
    static const char *const NAMES[] = {"White", "Red", "Green", "Blue", "Black"};
    return NAMES[pattern];
}

const float *pattern_codes(Pattern pattern) {
    static const float CODES[PATTERN_COUNT][3] = {
        {255, 255, 255}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {0, 0, 0}};
    return CODES[pattern];
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

static void look_at_emission(PlotData *s) {
    const json_t *emission = json_object_get(s->report, "emission");
    s->azimuths = few_azimuths(emission, s->arena);
    s->is_white_only = json_is_true(json_object_get(emission, "white_only"));
    s->has_gamma_table =
        s->is_white_only && json_is_true(json_object_get(emission, "levels_measured"));
    s->has_black = panel_figure_luminance(s->panel, 0, 0, PANEL_BLACK) > 0;
    s->cone = panel_info_emission_cone(s->panel);
    if (s->cone > radians_from_degrees(89.9)) s->cone = PI / 2;
}

static void look_at_reflection(PlotData *s) {
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    double azimuths[PANEL_INFO_AZIMUTHS_MAX];
    s->wavelength_count = panel_info_wavelengths(s->panel, nm);
    for (int i = 0; i < s->wavelength_count; i++)
        if (i == 0 || fabs((double)nm[i] - 550) < fabs(s->nm - 550)) s->nm = (double)nm[i];
    s->incidence_count = panel_info_incidences(s->panel, s->incidence);
    if (s->incidence_count > 0) s->last_incidence = s->incidence[s->incidence_count - 1];
    s->is_anisotropic = panel_info_azimuths(s->panel, azimuths) > 1;
}

PlotData *plot_data_new(const PlotInput *input, Arena *arena, Error *err) {
    PlotData *s = ARENA_NEW(arena, PlotData, 1);
    *s = (PlotData){.panel = input->panel,
                    .file = input->file,
                    .measured = input->measured,
                    .incidence_phi = input->incidence_phi,
                    .arena = arena};
    if (!panel_report(input->panel, &s->report, err)) {
        error_in_file(err, input->file);
        return NULL;
    }
    const char *name = json_string_value(json_object_get(s->report, "panel"));
    s->file_name = arena_printable(arena, path_name(input->file));
    s->name = name && *name ? arena_printable(arena, name) : s->file_name;
    if (input->reading) s->file_name = arena_format(arena, "%s, %s", s->file_name, input->reading);
    s->emits = panel_info_emits(s->panel);
    s->reflects = panel_reflects(s->panel);
    if (s->emits) look_at_emission(s);
    if (s->reflects) look_at_reflection(s);
    return s;
}

void plot_data_free(PlotData *data) {
    json_decref(data->report);
}

/* The leaving direction, and that to the light. */
static Vec3 leaving(const PlotData *s, double theta, double phi) {
    return panel_figure_direction(theta, phi + s->incidence_phi - PI);
}

static Vec3 to_light(const PlotData *s, double incidence) {
    return panel_figure_direction(incidence, s->incidence_phi);
}

double plot_data_brdf(const PlotData *s, double incidence, double theta, double phi, double nm) {
    return panel_figure_brdf(s->panel, leaving(s, theta, phi), to_light(s, incidence), nm);
}

bool plot_data_brdf_is_measured(const PlotData *s, double incidence, double theta, double phi) {
    return panel_brdf_is_measured(s->panel, leaving(s, theta, phi), to_light(s, incidence));
}
