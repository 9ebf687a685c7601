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

static void draw_curves(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    HaloSquare halo = halo_square_make(s->source.panel, canvas->arena);
    double reach = reach_of(&halo, s), high = 0;
    double mm[POINTS], (*value)[POINTS] = arena_alloc(canvas->arena, sizeof *value, 8, THETA_COUNT);
    int count = s->has_black ? THETA_COUNT : 1;
    for (int t = 0; t < count; t++)
        for (int i = 0; i < POINTS; i++) {
            mm[i] = reach * i / (POINTS - 1);
            value[t][i] = value_at(&halo, s->has_black, mm[i], THETAS[t]);
            high = fmax(high, value[t][i]);
        }
    Chart chart = chart_open(
        canvas, box, (AxisSpec){.high = reach, .title = "mm from the square's middle"},
        (AxisSpec){.low = high * DARKEST,
                   .high = high * 2,
                   .is_log = true,
                   .title = s->has_black ? "Luminance of black, cd/m²" : "Backlight over full"},
        44);
    for (int t = 0; t < count; t++) {
        Ink ink = panel_chart_series_ink(canvas, t, count);
        chart_curve(&chart, mm, value[t], POINTS, (Stroke){ink, t ? 1.4 : 1.9, DASH_NONE});
        chart_name_curve(&chart, mm, value[t], POINTS, ink,
                         arena_format(canvas->arena, "θ %g°", THETAS[t]));
    }
    chart_mark_x(&chart, 0.5 * halo.side_mm, (Stroke){canvas->theme.soft, 0.9, DASH_SHORT}, "edge");
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

/* ---- over the display -------------------------------------------------------------------- */

typedef struct HaloMap {
    const Backlight *backlight;
    int columns, rows;
} HaloMap;

static uint32_t pixel_at(const void *context, int x, int y) {
    const HaloMap *map = context;
    float place[2] = {((float)x + 0.5f) / (float)map->columns,
                      ((float)y + 0.5f) / (float)map->rows};
    double b = (double)backlight_at(map->backlight, place);
    return colour_map_pixel(MAP_SCATTER, 1 - log10(b) / log10(DARKEST));
}

static uint32_t scale_at(const void *context, int x, int y) {
    (void)context, (void)x;
    return colour_map_pixel(MAP_SCATTER, 1 - y / 63.0);
}

static void draw_zone_lines(Canvas *canvas, Box area, const DimmingZones *zones) {
    Stroke line = {ink_alpha(ink_hex(0xffffff), 0.16), 0.4, DASH_NONE};
    if (zones->count[0] > 100 || zones->count[1] > 100) return; /* they would hide the map */
    for (int i = 1; i < zones->count[0]; i++) {
        double x = area.x + area.w * i / zones->count[0];
        canvas_line(canvas, x, area.y, x, area.y + area.h, line);
    }
    for (int i = 1; i < zones->count[1]; i++) {
        double y = area.y + area.h * i / zones->count[1];
        canvas_line(canvas, area.x, y, area.x + area.w, y, line);
    }
}

static void draw_map(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const DimmingZones *zones = panel_zones(shown->data->source.panel);
    HaloSquare halo = halo_square_make(shown->data->source.panel, canvas->arena);
    double ratio = zones->size_mm[0] / zones->size_mm[1];
    Box area = {box.x, box.y + 4, box.w - 74, 0};
    HaloMap map = {halo.backlight, COLUMNS, (int)fmax(1, COLUMNS / ratio)};
    area.h = area.w / ratio;
    if (area.h > box.h - 12) area.h = box.h - 12, area.w = area.h * ratio;
    *out = (PanelChartMap){.kind = PANEL_CHART_PLAIN};
    canvas_image(canvas, area,
                 &(CanvasRaster){map.columns, map.rows, CAIRO_FORMAT_ARGB32, true, pixel_at, &map});
    draw_zone_lines(canvas, area, zones);
    Box bar = {area.x + area.w + 12, area.y, 12, area.h};
    Letters letters = {.size = SIZE_TICK, .ink = canvas->theme.soft};
    canvas_image(canvas, bar, &(CanvasRaster){1, 64, CAIRO_FORMAT_ARGB32, true, scale_at, NULL});
    canvas_text(canvas, bar.x + bar.w + 5, bar.y, letters, "full");
    letters.down = 0.5;
    canvas_text(canvas, bar.x + bar.w + 5, bar.y + 0.5 * bar.h, letters, "1 %");
    letters.down = 1;
    canvas_text(canvas, bar.x + bar.w + 5, bar.y + bar.h, letters, "0.01 %");
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
            draw_curves, s, 0, SHEET_ALWAYS, false});
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_HALO, "Backlight around a square", subtitle,
            "The backlight over full for the same picture, as someone facing the display sees it; "
            "thin lines part the zones.",
            draw_map, s, 0, SHEET_NEVER, false});
}

const PanelCharts halo_charts = {PLOT_HALO, PLOT_HALO, add_halo};
