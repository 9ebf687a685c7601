/* SPDX-License-Identifier: Apache-2.0 */
/* A panel that is not the same everywhere: white and black over the active area with the nine
 * points, and the viewing angle by place. */
#include <math.h>

#include "base/units.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_place.h"
#include "plot/draw/ticks.h"
#include "plot/panel/panel_chart.h"

#define COLUMNS 192
#define ROWS 108

/* ---- what is drawn ----------------------------------------------------------------------- */

/* The theta at which white has half the light of the local normal, degrees; the measured cone
 * where it never has. */
static double half_angle(const PlotData *s, const float place[2], double phi) {
    double angle = panel_figure_viewing_angle(s->source.panel, place,
                                              (PanelLimit){PANEL_LEAST_LUMINANCE, 0.5}, phi);
    return degrees_from_radians(isnan(angle) ? s->cone : angle);
}

/* Luminance of a pattern; 2: the whole angle over which it has half its light, across. */
static double value_at(const PlotData *s, int index, const float place[2]) {
    float xyz[3];
    if (index == 2) return half_angle(s, place, 0) + half_angle(s, place, PI);
    panel_place_emission_xyz(s->source.panel, place, vec3(0, 0, 1),
                             index ? PANEL_BLACK : PANEL_WHITE, xyz);
    return (double)xyz[1];
}

#define EVEN_SHARE 0.005
#define EVEN_REACH 0.05 /* of an even map's colours about its value: rounding shows none */

/* Its values, and whether they are no more than half a percent apart. */
static CellMap surface_map(const PlotData *s, int index, bool *is_even, Arena *arena) {
    int share = index == 2 ? 6 : 1; /* angles change slowly, and cost */
    CellMap out = {.columns = COLUMNS / share,
                   .rows = ROWS / share,
                   .map = MAP_AMOUNT,
                   .low = INFINITY,
                   .unit = index == 2 ? "degrees" : "cd/m²"};
    out.value = ARENA_NEW(arena, float, out.columns *out.rows);
    for (int i = 0; i < out.columns * out.rows; i++) {
        float place[2] = {((float)(i % out.columns) + 0.5f) / (float)out.columns,
                          ((float)(i / out.columns) + 0.5f) / (float)out.rows};
        double value = value_at(s, index, place);
        out.value[i] = (float)value;
        out.low = fmin(out.low, value);
        out.high = fmax(out.high, value);
    }
    *is_even = out.high - out.low <= EVEN_SHARE * out.high;
    if (*is_even) {
        double middle = 0.5 * (out.low + out.high);
        out.low = middle * (1 - EVEN_REACH);
        out.high = middle * (1 + EVEN_REACH);
    }
    return out;
}

/* ---- drawing ----------------------------------------------------------------------------- */

/* As wide as the display where its size is known. */
static double ratio_of(const PlotData *s) {
    const json_t *size = json_object_get(s->source.report, "size_mm");
    double w = json_number_value(json_array_get(size, 0));
    double h = json_number_value(json_array_get(size, 1));
    return w > 0 && h > 0 ? w / h : 16.0 / 9;
}

/* Colours, the nine points' values and rings where the panel was measured. */
static void fill_surface(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    bool is_even;
    int map[2];
    float(*nine)[2] = arena_alloc(out->arena, sizeof *nine, 8, PANEL_NINE);
    float(*spot)[2] = arena_alloc(out->arena, sizeof *spot, 8, PANEL_EVENNESS_SPOTS);
    double *value = ARENA_NEW(out->arena, double, PANEL_NINE);
    char text[2][32];
    CellMap *cells = &out->cells;
    *cells = surface_map(s, shown->index, &is_even, out->arena);
    for (int i = 0; i < PANEL_NINE; i++) {
        panel_nine_place(i, nine[i]);
        value[i] = value_at(s, shown->index, nine[i]);
    }
    cells->ratio = ratio_of(s);
    cells->scale[0] = arena_format(out->arena, "%s", figure_text(cells->high, text[0]));
    cells->scale[1] = cells->unit;
    cells->scale[2] = arena_format(out->arena, "%s", figure_text(cells->low, text[1]));
    cells->figure_count = PANEL_NINE;
    cells->figure = (const float(*)[2])nine;
    cells->figure_value = value;
    cells->ring_count = panel_spots(s->source.panel, spot, map);
    cells->ring = (const float(*)[2])spot;
}

/* ---- the charts -------------------------------------------------------------------------- */

/* angle: "" or what is to be said of the viewing angle. */
static void add_surface(PanelChartList *list, const PlotData *s, int index, const char *angle) {
    PanelEvenness e = panel_figure_evenness(s->source.panel, index ? PANEL_BLACK : PANEL_WHITE);
    char text[4][32];
    bool is_even = e.most - e.least <= EVEN_SHARE * e.most;
    const char *subtitle = arena_format(
        s->arena,
        "%snine points: least %s, most %s, mean %s "
        "cd/m², non-uniformity %s %%%s",
        is_even ? "nearly constant; " : "", figure_text(e.nine_least, text[0]),
        figure_text(e.nine_most, text[1]), figure_text(e.nine_mean, text[2]),
        figure_text(100 * panel_non_uniformity(e.nine_least, e.nine_most), text[3]), angle);
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_UNIFORMITY, index ? "Black over the active area" : "White over the active area",
            subtitle,
            "Luminance along the local normal over the active area, as someone facing the display "
            "sees it. The numbers are those of the nine points, a tenth, a half and nine tenths of "
            "width and height; rings stand where the panel was measured.",
            fill_surface, s, index, index ? SHEET_NEVER : SHEET_ALWAYS, false});
}

static void add_place(PanelChartList *list, const PlotData *s) {
    if (!s->emits || !panel_varies(s->source.panel)) return;
    bool is_even;
    CellMap angle = surface_map(s, 2, &is_even, s->arena);
    char text[32];
    const char *everywhere = arena_format(s->arena, "; half luminance over %s° at every place",
                                          figure_text((double)angle.value[0], text));
    add_surface(list, s, 0, is_even ? everywhere : "");
    if (s->has_black) add_surface(list, s, 1, "");
    if (is_even) return;
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_UNIFORMITY, "Viewing angle by place",
            "degrees, left to right, over which white has half the light of the local normal",
            "The whole horizontal angle, from left to right, inside which white has at least half "
            "the luminance of the local normal; no more than was measured.",
            fill_surface, s, 2, SHEET_NEVER, false});
}

const PanelCharts place_charts = {PLOT_UNIFORMITY, PLOT_UNIFORMITY, add_place};
