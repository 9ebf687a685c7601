/* SPDX-License-Identifier: Apache-2.0 */
/* Local dimming: the halo of a white square on black, beside it and over the display. */
#include <math.h>

#include "base/units.h"
#include "panel/set/halo_square.h"
#include "panel/zones/backlight_at.h"
#include "plot/draw/ticks.h"
#include "plot/panel/panel_chart.h"

#define POINTS 201
#define COLUMNS 240
#define DARKEST 1e-4       /* of full: the map's colours begin there */
#define REACH_MOST_MM 80.0 /* from the square's middle */
#define REACH_STEP_MM 5.0

static const double THETAS[] = {0, 30, 60}; /* degrees, along azimuth 45 */
#define THETA_COUNT ((int)(sizeof THETAS / sizeof *THETAS))

static Vec3 towards(double theta_deg) {
    double theta = radians_from_degrees(theta_deg), phi = radians_from_degrees(45);
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
}

/* ---- beside the square ------------------------------------------------------------------- */

/* Black at all angles; of a display without any its backlight. */
static double value_at(const HaloSquare *halo, bool has_black, double mm, double theta) {
    return has_black ? halo_square_black(halo, mm, towards(theta))
                     : halo_square_backlight(halo, mm);
}

/* To where the last of the curves leaves the chart, in whole steps; the square is on it. */
static double reach_of(const HaloSquare *halo, const PlotData *s) {
    double half = fmin(REACH_MOST_MM, 0.5 * panel_zones(s->source.panel)->size_mm[0]);
    double least = value_at(halo, s->has_black, 0, 0) * DARKEST, reach = 0.5 * halo->side_mm;
    for (int t = 0; t < (s->has_black ? THETA_COUNT : 1); t++)
        for (int i = 0; i < POINTS; i++) {
            double mm = half * i / (POINTS - 1);
            if (value_at(halo, s->has_black, mm, THETAS[t]) > least) reach = fmax(reach, mm);
        }
    return fmin(half, REACH_STEP_MM * ceil(1.02 * reach / REACH_STEP_MM));
}

static void fill_curves(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    HaloSquare halo = halo_square_make(s->source.panel, out->arena);
    double reach = reach_of(&halo, s), high = 0;
    int count = s->has_black ? THETA_COUNT : 1;
    for (int t = 0; t < count; t++) {
        ChartPoints p = chart_rows_points(out, POINTS);
        for (int i = 0; i < POINTS; i++) {
            p.x[i] = reach * i / (POINTS - 1);
            p.y[i] = value_at(&halo, s->has_black, p.x[i], THETAS[t]);
            high = fmax(high, p.y[i]);
        }
        Stroke stroke = {panel_chart_series_ink(out->theme, t, count), t ? 1.4 : 1.9, DASH_NONE};
        Series *curve = chart_rows_add(out, SERIES_CURVE,
                                       arena_format(out->arena, "θ %g°", THETAS[t]), stroke, p);
        curve->label = curve->name;
    }
    chart_rows_line(out, 0.5 * halo.side_mm, (Stroke){out->theme->soft, 0.9, DASH_SHORT}, "edge");
    out->x = axis_even(0, reach, "mm from the square's middle");
    out->y = axis_log(high * DARKEST, high * 2,
                      s->has_black ? "Luminance of black, cd/m²" : "Backlight over full");
    out->right = 44;
}

/* ---- over the display -------------------------------------------------------------------- */

static void fill_map(const PanelChart *shown, ChartRows *out) {
    const DimmingZones *zones = panel_zones(shown->data->source.panel);
    HaloSquare halo = halo_square_make(shown->data->source.panel, out->arena);
    double ratio = zones->size_mm[0] / zones->size_mm[1];
    CellMap map = {.columns = COLUMNS,
                   .rows = (int)fmax(1, COLUMNS / ratio),
                   .map = MAP_SCATTER,
                   .low = DARKEST,
                   .high = 1,
                   .is_log = true,
                   .ratio = ratio,
                   .scale = {"full", "1 %", "0.01 %"},
                   .unit = "backlight over full"};
    map.value = ARENA_NEW(out->arena, float, map.columns *map.rows);
    for (int i = 0; i < map.columns * map.rows; i++) {
        float place[2] = {((float)(i % map.columns) + 0.5f) / (float)map.columns,
                          ((float)(i / map.columns) + 0.5f) / (float)map.rows};
        map.value[i] = backlight_at(halo.backlight, place);
    }
    if (zones->count[0] <= 100 && zones->count[1] <= 100) /* more would hide the map */
        for (int i = 0; i < 2; i++) map.lines[i] = zones->count[i];
    out->cells = map;
}

/* ---- the charts -------------------------------------------------------------------------- */

static void add_halo(PanelChartList *list, const PlotData *s) {
    if (!s->emits || !panel_zones(s->source.panel)) return;
    HaloSquare halo = halo_square_make(s->source.panel, s->arena);
    char text[3][32];
    const char *subtitle = arena_format(s->arena,
                                        "white square of %s mm on black; mean drive "
                                        "%s %%, of black %s %%",
                                        figure_text(halo.side_mm, text[0]),
                                        figure_text(100 * halo.backlight->mean_drive, text[1]),
                                        figure_text(100 * halo.black_drive, text[2]));
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_HALO, "Halo beside a square", subtitle,
            "What black shines beside a white square, along azimuth 45° at three angles from the "
            "normal: the black that was measured there, times the backlight that the square's "
            "zones leave at that distance.",
            fill_curves, s, 0, SHEET_ALWAYS, false});
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_HALO, "Backlight around a square", subtitle,
            "The backlight over full for the same picture, as someone facing the display sees it; "
            "thin lines part the zones.",
            fill_map, s, 0, SHEET_NEVER, false});
}

const PanelCharts halo_charts = {PLOT_HALO, PLOT_HALO, add_halo};
