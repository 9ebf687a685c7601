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
#define SCALE_WIDTH 12.0 /* points */

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

typedef struct SurfaceMap {
    int columns, rows;
    float *value;
    double low, high; /* of the colours */
    bool is_even;     /* no more than half a percent between the least and the most */
} SurfaceMap;

#define EVEN_SHARE 0.005
#define EVEN_REACH 0.05 /* of an even map's colours about its value: rounding shows none */

static SurfaceMap surface_map(const PlotData *s, int index, Arena *arena) {
    int share = index == 2 ? 6 : 1; /* angles change slowly, and cost */
    SurfaceMap out = {COLUMNS / share, ROWS / share, NULL, INFINITY, 0, false};
    out.value = ARENA_NEW(arena, float, out.columns *out.rows);
    for (int i = 0; i < out.columns * out.rows; i++) {
        float place[2] = {((float)(i % out.columns) + 0.5f) / (float)out.columns,
                          ((float)(i / out.columns) + 0.5f) / (float)out.rows};
        double value = value_at(s, index, place);
        out.value[i] = (float)value;
        out.low = fmin(out.low, value);
        out.high = fmax(out.high, value);
    }
    out.is_even = out.high - out.low <= EVEN_SHARE * out.high;
    if (out.is_even) {
        double middle = 0.5 * (out.low + out.high);
        out.low = middle * (1 - EVEN_REACH);
        out.high = middle * (1 + EVEN_REACH);
    }
    return out;
}

/* ---- drawing ----------------------------------------------------------------------------- */

static double position(const SurfaceMap *map, double value) {
    return map->high > map->low ? (value - map->low) / (map->high - map->low) : 0.5;
}

static uint32_t pixel_at(const void *context, int x, int y) {
    const SurfaceMap *map = context;
    return colour_map_pixel(MAP_AMOUNT, position(map, (double)map->value[y * map->columns + x]));
}

/* Colours, one a cell, into the box. */
static void paint(Canvas *canvas, Box box, const SurfaceMap *map) {
    canvas_image(
        canvas, box,
        &(CanvasRaster){map->columns, map->rows, CAIRO_FORMAT_ARGB32, true, pixel_at, map});
}

/* As wide as the display where its size is known. */
static Box surface_box(const PlotData *s, Box box) {
    const json_t *size = json_object_get(s->source.report, "size_mm");
    double w = json_number_value(json_array_get(size, 0));
    double h = json_number_value(json_array_get(size, 1));
    double ratio = w > 0 && h > 0 ? w / h : 16.0 / 9;
    Box out = {box.x, box.y + 4, box.w - SCALE_WIDTH - 62, 0};
    out.h = out.w / ratio;
    if (out.h > box.h - 12) out.h = box.h - 12, out.w = out.h * ratio;
    return out;
}

static void write_point(Canvas *canvas, const Box *box, const SurfaceMap *map, const float place[2],
                        double value) {
    char text[32];
    double x = box->x + (double)place[0] * box->w, y = box->y + (double)place[1] * box->h;
    Ink ink = colour_map_wants_light_ink(MAP_AMOUNT, position(map, value)) ? ink_hex(0xffffff)
                                                                           : ink_hex(0x000000);
    canvas_text(canvas, x, y, (Letters){.size = SIZE_TICK, .ink = ink, .across = 0.5, .down = 0.5},
                figure_text(value, text));
}

static void mark_spots(Canvas *canvas, const Box *box, const PlotData *s) {
    float place[PANEL_EVENNESS_SPOTS][2];
    int map[2], count = panel_spots(s->source.panel, place, map);
    for (int i = 0; i < count; i++)
        canvas_circle(canvas, box->x + (double)place[i][0] * box->w,
                      box->y + (double)place[i][1] * box->h, 11);
    canvas_stroke(canvas, (Stroke){ink_alpha(ink_hex(0xffffff), 0.8), 0.9, DASH_NONE});
}

static void draw_scale(Canvas *canvas, Box box, const SurfaceMap *map, const char *unit) {
    SurfaceMap bar = {1, 64, ARENA_NEW(canvas->arena, float, 64), map->low, map->high, false};
    char text[2][32];
    Letters letters = {.size = SIZE_TICK, .ink = canvas->theme.soft};
    for (int i = 0; i < 64; i++)
        bar.value[i] = (float)(map->high - (map->high - map->low) * i / 63.0);
    paint(canvas, box, &bar);
    canvas_text(canvas, box.x + box.w + 5, box.y, letters, figure_text(map->high, text[0]));
    letters.down = 1;
    canvas_text(canvas, box.x + box.w + 5, box.y + box.h, letters, figure_text(map->low, text[1]));
    letters.down = 0.5;
    canvas_text(canvas, box.x + box.w + 5, box.y + 0.5 * box.h, letters, unit);
}

static void draw_surface(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    SurfaceMap map = surface_map(s, shown->index, canvas->arena);
    Box area = surface_box(s, box);
    *out = (PanelChartMap){.kind = PANEL_CHART_PLAIN};
    paint(canvas, area, &map);
    mark_spots(canvas, &area, s);
    for (int i = 0; i < PANEL_NINE; i++) {
        float place[2];
        panel_nine_place(i, place);
        write_point(canvas, &area, &map, place, value_at(s, shown->index, place));
    }
    draw_scale(canvas, (Box){area.x + area.w + 12, area.y, SCALE_WIDTH, area.h}, &map,
               shown->index == 2 ? "degrees" : "cd/m²");
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
            draw_surface, s, index, index ? SHEET_NEVER : SHEET_ALWAYS, false});
}

static void add_place(PanelChartList *list, const PlotData *s) {
    if (!s->emits || !panel_varies(s->source.panel)) return;
    SurfaceMap angle = surface_map(s, 2, s->arena);
    char text[32];
    const char *everywhere = arena_format(s->arena, "; half luminance over %s° at every place",
                                          figure_text((double)angle.value[0], text));
    add_surface(list, s, 0, angle.is_even ? everywhere : "");
    if (s->has_black) add_surface(list, s, 1, "");
    if (angle.is_even) return;
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_UNIFORMITY, "Viewing angle by place",
            "degrees, left to right, over which white has half the light of the local normal",
            "The whole horizontal angle, from left to right, inside which white has at least half "
            "the luminance of the local normal; no more than was measured.",
            draw_surface, s, 2, SHEET_NEVER, false});
}

const PanelCharts place_charts = {PLOT_UNIFORMITY, PLOT_UNIFORMITY, add_place};
