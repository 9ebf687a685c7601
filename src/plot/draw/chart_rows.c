/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/chart_rows.h"

#include <assert.h>
#include <math.h>

#include "plot/draw/ticks.h"

ChartPoints chart_rows_points(const ChartRows *rows, int count) {
    return (ChartPoints){count, ARENA_NEW(rows->arena, double, count),
                         ARENA_NEW(rows->arena, double, count)};
}

Series *chart_rows_add(ChartRows *rows, SeriesKind kind, const char *name, Stroke stroke,
                       ChartPoints points) {
    assert(rows->count < SERIES_MAX);
    rows->kind = CHART_AXES;
    Series *series = &rows->series[rows->count++];
    *series = (Series){.kind = kind, .name = name, .stroke = stroke, .points = points};
    return series;
}

static Series *add_at(ChartRows *rows, SeriesKind kind, double a, double b, Stroke stroke) {
    Series *series = chart_rows_add(rows, kind, NULL, stroke, (ChartPoints){0});
    series->at[0] = a;
    series->at[1] = b;
    return series;
}

void chart_rows_hatch(ChartRows *rows, double x0, double x1) {
    add_at(rows, SERIES_HATCH, x0, x1, (Stroke){.width = 0});
}

void chart_rows_line(ChartRows *rows, double x, Stroke stroke, const char *label) {
    add_at(rows, SERIES_LINE, x, 0, stroke)->label = label;
}

Series *chart_rows_word(ChartRows *rows, double x, double y, Ink ink, const char *label) {
    Series *word = add_at(rows, SERIES_WORD, x, y, (Stroke){.ink = ink});
    word->label = label;
    return word;
}

/* ---- over axes --------------------------------------------------------------------------- */

/* A unit is as long on both axes; the ranges grow about their middles. */
static void make_square(Box box, AxisSpec *x, AxisSpec *y) {
    double w = box.w - 42 - 14, h = box.h - 56;
    double scale = fmin(w / (x->high - x->low), h / (y->high - y->low));
    double from[2] = {(x->low + x->high - w / scale) / 2, (y->low + y->high - h / scale) / 2};
    x->low = from[0], x->high = from[0] + w / scale;
    y->low = from[1], y->high = from[1] + h / scale;
}

static bool is_inside(const Chart *chart, double px, double py) {
    Box p = chart->plot;
    return px >= p.x - 1 && px <= p.x + p.w + 1 && py >= p.y - 1 && py <= p.y + p.h + 1;
}

/* Pale where it is extrapolated. */
static void draw_curve(Chart *chart, const Series *s) {
    for (int begin = 0, i = 1; i <= s->points.count; i++) {
        bool goes_on = i < s->points.count && (!s->is_pale || s->is_pale[i] == s->is_pale[begin]);
        if (goes_on) continue;
        int last = i < s->points.count ? i + 1 : i; /* the next piece's first point joins them */
        Stroke stroke = s->stroke;
        if (s->is_pale && s->is_pale[begin]) stroke.ink = ink_alpha(stroke.ink, 0.3);
        chart_curve(chart, s->points.x + begin, s->points.y + begin, last - begin, stroke);
        begin = i;
    }
    if (!s->label || s->is_key) return;
    if (s->label_index)
        chart_name(chart, s->points.x[s->label_index], s->points.y[s->label_index], s->stroke.ink,
                   s->label);
    else
        chart_name_curve(chart, s->points.x, s->points.y, s->points.count, s->stroke.ink, s->label);
}

static void draw_rings(const Chart *chart, const Series *s) {
    for (int i = 0; i < s->points.count; i++) {
        double px = chart_x(chart, s->points.x[i]), py = chart_y(chart, s->points.y[i]);
        if (!is_inside(chart, px, py)) continue;
        canvas_circle(chart->canvas, px, py, s->stroke.width);
        canvas_stroke(chart->canvas, (Stroke){s->stroke.ink, 0.8, DASH_NONE});
    }
}

static void fill_area(const Chart *chart, const Series *s) {
    cairo_t *cr = chart->canvas->cr;
    double bottom = chart->plot.y + chart->plot.h;
    cairo_move_to(cr, chart_x(chart, s->points.x[0]), bottom);
    for (int i = 0; i < s->points.count; i++)
        cairo_line_to(cr, chart_x(chart, s->points.x[i]), chart_y(chart, s->points.y[i]));
    cairo_line_to(cr, chart_x(chart, s->points.x[s->points.count - 1]), bottom);
    canvas_fill(chart->canvas, s->stroke.ink);
}

static void fill_bars(const Chart *chart, const Series *s) {
    for (int i = 0; i < s->points.count; i++) {
        if (!(s->points.y[i] > 0)) continue;
        double x0 = chart_x(chart, s->points.x[i]), x1 = chart_x(chart, s->points.x[i + 1]);
        double y = chart_y(chart, s->points.y[i]);
        cairo_rectangle(chart->canvas->cr, x0 + 0.4, y, x1 - x0 - 0.8,
                        chart->plot.y + chart->plot.h - y);
        canvas_fill(chart->canvas, s->stroke.ink);
    }
}

/* last: where the word before stands; of the first one far away. */
static void write_word(const Chart *chart, const Series *s, double last[2]) {
    double x = chart_x(chart, s->at[0]) + s->dx, y = chart_y(chart, s->at[1]) + s->dy;
    if (s->crowd == CROWD_GOES_DOWN && y < last[1] + 12) y = last[1] + 12;
    if (s->crowd == CROWD_IS_LEFT_OUT && x - last[0] < 15 && fabs(y - last[1]) < 12) return;
    canvas_text(chart->canvas, x, y,
                (Letters){.size = SIZE_TICK,
                          .ink = s->stroke.ink,
                          .across = s->across,
                          .down = 1,
                          .halo = chart->canvas->theme.paper},
                s->label);
    last[0] = x;
    last[1] = y;
}

#define KEY_LEADING 14.0

/* In a corner that the curves leave free, where they run too near each other for names. */
static void draw_key(const Chart *chart, const ChartRows *rows) {
    Canvas *canvas = chart->canvas;
    int count = 0;
    for (int i = 0; i < rows->count; i++) count += rows->series[i].is_key;
    double x = chart->plot.x + 10, y = chart->plot.y + KEY_LEADING;
    if (rows->key == KEY_LOWER_RIGHT) x = chart->plot.x + chart->plot.w - 106;
    if (rows->key != KEY_UPPER_LEFT)
        y = chart->plot.y + chart->plot.h - 10 - KEY_LEADING * (count - 1);
    for (int i = rows->count - 1; i >= 0; i--) {
        const Series *s = &rows->series[i];
        if (!s->is_key) continue;
        canvas_line(canvas, x, y, x + 22, y, s->stroke);
        canvas_text(canvas, x + 28, y,
                    (Letters){.size = SIZE_TICK,
                              .ink = canvas->theme.ink,
                              .down = 0.5,
                              .halo = canvas->theme.paper},
                    s->label);
        y += KEY_LEADING;
    }
}

static void draw_series(Chart *chart, const Series *s, double last[2]) {
    switch (s->kind) {
    case SERIES_CURVE: draw_curve(chart, s); break;
    case SERIES_DOTS:
        for (int i = 0; i < s->points.count; i++)
            chart_dot(chart, s->points.x[i], s->points.y[i], s->stroke.width, s->stroke.ink);
        break;
    case SERIES_RINGS: draw_rings(chart, s); break;
    case SERIES_AREA: fill_area(chart, s); break;
    case SERIES_BARS: fill_bars(chart, s); break;
    case SERIES_HATCH: chart_hatch(chart, s->at[0], s->at[1]); break;
    case SERIES_LINE: chart_mark_x(chart, s->at[0], s->stroke, s->label); break;
    case SERIES_WORD: write_word(chart, s, last); break;
    }
}

static ChartMap draw_axes(Canvas *canvas, Box box, const ChartRows *rows) {
    AxisSpec x = rows->x, y = rows->y;
    double last[2] = {-INFINITY, -INFINITY};
    if (rows->is_square) make_square(box, &x, &y);
    Chart chart = chart_open(canvas, box, x, y, rows->right);
    if (rows->ground) rows->ground(&chart);
    for (int i = 0; i < rows->count; i++) draw_series(&chart, &rows->series[i], last);
    draw_key(&chart, rows);
    chart_close(&chart);
    return (ChartMap){CHART_AXES,
                      {0, 0, 0},
                      chart.plot,
                      {chart.x.low, chart.y.low},
                      {chart.x.high, chart.y.high}};
}

/* ---- over the display -------------------------------------------------------------------- */

#define SCALE_WIDTH 12.0

static double position(const CellMap *map, double value) {
    if (!(map->high > map->low)) return 0.5;
    return map->is_log ? log(value / map->low) / log(map->high / map->low)
                       : (value - map->low) / (map->high - map->low);
}

static uint32_t pixel_at(const void *context, int x, int y) {
    const CellMap *map = context;
    return colour_map_pixel(map->map, position(map, (double)map->value[y * map->columns + x]));
}

static uint32_t scale_at(const void *context, int x, int y) {
    const CellMap *map = context;
    (void)x;
    return colour_map_pixel(map->map, map->high > map->low ? 1 - y / 63.0 : 0.5);
}

static void draw_parts(Canvas *canvas, Box area, const int parts[2]) {
    Stroke line = {ink_alpha(ink_hex(0xffffff), 0.16), 0.4, DASH_NONE};
    for (int i = 1; i < parts[0]; i++) {
        double x = area.x + area.w * i / parts[0];
        canvas_line(canvas, x, area.y, x, area.y + area.h, line);
    }
    for (int i = 1; i < parts[1]; i++) {
        double y = area.y + area.h * i / parts[1];
        canvas_line(canvas, area.x, y, area.x + area.w, y, line);
    }
}

static void write_figures(Canvas *canvas, Box area, const CellMap *map) {
    for (int i = 0; i < map->figure_count; i++) {
        char text[32];
        bool is_dark = colour_map_wants_light_ink(map->map, position(map, map->figure_value[i]));
        canvas_text(canvas, area.x + (double)map->figure[i][0] * area.w,
                    area.y + (double)map->figure[i][1] * area.h,
                    (Letters){.size = SIZE_TICK,
                              .ink = ink_hex(is_dark ? 0xffffff : 0x000000),
                              .across = 0.5,
                              .down = 0.5},
                    figure_text(map->figure_value[i], text));
    }
}

static void draw_cells(Canvas *canvas, Box box, const CellMap *map) {
    Box area = {box.x, box.y + 4, box.w - SCALE_WIDTH - 62, 0};
    area.h = area.w / map->ratio;
    if (area.h > box.h - 12) area.h = box.h - 12, area.w = area.h * map->ratio;
    canvas_image(
        canvas, area,
        &(CanvasRaster){map->columns, map->rows, CAIRO_FORMAT_ARGB32, true, pixel_at, map});
    draw_parts(canvas, area, map->lines);
    for (int i = 0; i < map->ring_count; i++)
        canvas_circle(canvas, area.x + (double)map->ring[i][0] * area.w,
                      area.y + (double)map->ring[i][1] * area.h, 11);
    canvas_stroke(canvas, (Stroke){ink_alpha(ink_hex(0xffffff), 0.8), 0.9, DASH_NONE});
    write_figures(canvas, area, map);
    Box bar = {area.x + area.w + 12, area.y, SCALE_WIDTH, area.h};
    canvas_image(canvas, bar, &(CanvasRaster){1, 64, CAIRO_FORMAT_ARGB32, true, scale_at, map});
    for (int i = 0; i < 3; i++)
        canvas_text(canvas, bar.x + bar.w + 5, bar.y + 0.5 * i * bar.h,
                    (Letters){.size = SIZE_TICK, .ink = canvas->theme.soft, .down = 0.5 * i},
                    map->scale[i]);
}

ChartMap chart_rows_draw(Canvas *canvas, Box box, const ChartRows *rows) {
    if (rows->kind == CHART_AXES) return draw_axes(canvas, box, rows);
    if (rows->kind == CHART_POLAR)
        return (ChartMap){.kind = CHART_POLAR, .disc = polar_draw(canvas, box, &rows->polar)};
    draw_cells(canvas, box, &rows->cells);
    return (ChartMap){.kind = CHART_PLAIN};
}
