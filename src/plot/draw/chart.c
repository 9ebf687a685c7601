/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/chart.h"

#include <assert.h>
#include <math.h>

#include "base/units.h"
#include "plot/draw/ticks.h"

/* ---- rows -------------------------------------------------------------------------------- */

Chart *chart_new(ChartKind kind, const char *title, const char *x, const char *value,
                 Arena *arena) {
    static const char *const KEYS[][2] = {[CHART_AXES] = {"of", NULL},
                                          [CHART_POLAR] = {"theta_deg", "phi_deg"},
                                          [CHART_AREA] = {"u", "v"}};
    Chart *chart = ARENA_NEW(arena, Chart, 1);
    Column *columns = ARENA_NEW(arena, Column, 3);
    TableKind *rows = ARENA_NEW(arena, TableKind, 1);
    columns[0].key = KEYS[kind][0];
    columns[1].key = x ? x : KEYS[kind][1];
    columns[2].key = x ? value : arena_format(arena, "%s, %s", title, value);
    columns[2].words = value;
    *rows = (TableKind){"chart", title, columns, 3};
    *chart = (Chart){.kind = kind,
                     .title = title,
                     .subtitle = "",
                     .table = table_new(rows, arena),
                     .measured = {-INFINITY, INFINITY},
                     .strong = NAN,
                     .ratio = 1};
    return chart;
}

Series *chart_series(Chart *chart, const char *name, Stroke stroke) {
    assert(chart->series_count < SERIES_MAX);
    Series *series = &chart->series[chart->series_count++];
    *series = (Series){name, chart->table->row_count, 0, false, stroke, false};
    return series;
}

void chart_point(Chart *chart, double x, double y) {
    Series *series = &chart->series[chart->series_count - 1];
    series->count++;
    table_row(chart->table);
    table_text(chart->table, series->name);
    table_number(chart->table, x);
    table_number(chart->table, y);
}

void chart_fill(Chart *chart, ChartQuantity *quantity, const void *context) {
    bool is_polar = chart->kind == CHART_POLAR;
    int columns = is_polar ? CHART_PHIS : CHART_COLUMNS;
    int rows = is_polar ? CHART_THETAS : CHART_ROWS;
    for (int i = 0; i < rows * columns; i++) {
        double a = is_polar ? i / columns : (i % columns + 0.5) / columns;
        double b = is_polar ? 360.0 / columns * (i % columns) : (i / columns + 0.5) / rows;
        double unit = is_polar ? radians_from_degrees(1) : 1;
        table_row(chart->table);
        table_number(chart->table, a);
        table_number(chart->table, b);
        table_number(chart->table, quantity(context, a * unit, b * unit));
    }
}

double chart_cell(const Chart *chart, int row, int column) {
    return chart->table->cells[3 * row + column].value;
}

ChartRange chart_range(const Chart *chart, double theta_deg) {
    ChartRange range = {INFINITY, -INFINITY, 0};
    for (int row = 0; row < chart->table->row_count; row++) {
        double value = chart_cell(chart, row, 2);
        if (!isfinite(value)) continue;
        if (chart->kind == CHART_POLAR && chart_cell(chart, row, 0) > theta_deg + 1e-6) continue;
        range.low = fmin(range.low, value);
        if (value > range.high) range.highest = row;
        range.high = fmax(range.high, value);
    }
    return range.high < range.low ? (ChartRange){0} : range;
}

/* ---- an axis, or a scale of colours ------------------------------------------------------ */

static ChartAxis with_extent(ChartAxis axis) {
    if (axis.is_log && !(axis.high > 0)) axis.high = 1;
    if (axis.is_log && !(axis.low > 0 && axis.low < axis.high)) axis.low = axis.high / 10;
    if (!axis.is_log && !(axis.high > axis.low)) axis.high = axis.low + 1;
    return axis;
}

/* 0 at the low end, 1 at the high one; logarithms of nothing are far below. */
static double position(const ChartAxis *axis, double value) {
    if (!axis->is_log) return (value - axis->low) / (axis->high - axis->low);
    return value > 0 ? log(value / axis->low) / log(axis->high / axis->low) : -9;
}

/* room: what a tick needs, points. */
static Ticks axis_ticks(const ChartAxis *axis, double length, double room) {
    int most = (int)fmin(fmax(length / room, 2), 10);
    if (axis->is_log) return ticks_log(axis->low, axis->high, most);
    for (int times = 1; times <= 2; times++)
        if (axis->step > 0 && (axis->high - axis->low) / axis->step / times <= most)
            return ticks_every(times * axis->step, axis->low, axis->high);
    return ticks_linear(axis->low, axis->high, most);
}

static const char *label_of(Canvas *canvas, const ChartAxis *axis, const Ticks *ticks, int i) {
    char text[32];
    tick_text(ticks->value[i], axis->is_log ? 0 : ticks->step, text);
    return arena_format(canvas->arena, "%s%s", text, axis->suffix ? axis->suffix : "");
}

/* ---- curves over axes -------------------------------------------------------------------- */

#define KEY_WIDTH 84.0
#define KEY_LEADING 14.0

/* A chart's axes on the page. */
typedef struct ChartPlane {
    Canvas *canvas;
    Box plot;
    ChartAxis x, y;
} ChartPlane;

static double plane_x(const ChartPlane *plane, double value) {
    return plane->plot.x + plane->plot.w * position(&plane->x, value);
}

static double plane_y(const ChartPlane *plane, double value) {
    return plane->plot.y + plane->plot.h * (1 - position(&plane->y, value));
}

/* A unit is as long on both axes; the ranges grow about their middles. */
static void make_square(ChartPlane *plane) {
    ChartAxis *x = &plane->x, *y = &plane->y;
    double w = plane->plot.w, h = plane->plot.h;
    double scale = fmin(w / (x->high - x->low), h / (y->high - y->low));
    double from[2] = {(x->low + x->high - w / scale) / 2, (y->low + y->high - h / scale) / 2};
    x->low = from[0], x->high = from[0] + w / scale;
    y->low = from[1], y->high = from[1] + h / scale;
}

static void draw_grid(const ChartPlane *plane, Box box, const Chart *chart) {
    Canvas *canvas = plane->canvas;
    Box p = plane->plot;
    Ticks ticks = axis_ticks(&plane->x, p.w, plane->x.is_log ? 30 : 38);
    Stroke grid = {INK_GRID, 0.8, DASH_NONE}, faint = {INK_FAINT, 0.8, DASH_NONE};
    Letters letters = {.size = SIZE_TICK, .ink = INK_SOFT, .across = 0.5};
    for (int i = 0; i < ticks.count; i++) {
        double x = plane_x(plane, ticks.value[i]), length = ticks.is_labelled[i] ? 4 : 2.5;
        canvas_line(canvas, x, p.y + p.h, x, p.y + p.h + length, faint);
        if (!ticks.is_labelled[i]) continue;
        canvas_line(canvas, x, p.y, x, p.y + p.h, grid);
        canvas_text(canvas, x, p.y + p.h + 7, letters, label_of(canvas, &plane->x, &ticks, i));
    }
    ticks = axis_ticks(&plane->y, p.h, 26);
    letters.across = 1;
    letters.down = 0.5;
    for (int i = 0; i < ticks.count; i++) {
        double y = plane_y(plane, ticks.value[i]);
        if (!ticks.is_labelled[i]) {
            canvas_line(canvas, p.x - 2.5, y, p.x, y, faint);
            continue;
        }
        canvas_line(canvas, p.x - 4, y, p.x + p.w, y, grid);
        canvas_text(canvas, p.x - 7, y, letters, label_of(canvas, &plane->y, &ticks, i));
    }
    canvas_text(canvas, p.x + p.w, p.y + p.h + 21,
                (Letters){.size = SIZE_TICK, .ink = INK_TEXT, .across = 1},
                chart->table->kind->columns[1].key);
    canvas_text(canvas, box.x, p.y - 10, (Letters){.size = SIZE_TICK, .ink = INK_TEXT, .down = 1},
                chart->table->kind->columns[2].words);
    canvas_line(canvas, p.x, p.y + p.h, p.x + p.w, p.y + p.h, (Stroke){INK_FAINT, 0.9, DASH_NONE});
}

/* Values that are not there interrupt a curve. */
static void draw_series(const ChartPlane *plane, const Chart *chart, const Series *series) {
    Canvas *canvas = plane->canvas;
    cairo_t *cr = canvas->cr;
    Box p = plane->plot;
    bool is_open = false;
    cairo_save(cr);
    cairo_rectangle(cr, p.x - 2, p.y - 2, p.w + 4, p.h + 4);
    cairo_clip(cr);
    for (int row = series->first; row < series->first + series->count; row++) {
        double x = chart_cell(chart, row, 1), y = chart_cell(chart, row, 2);
        bool is_there = isfinite(x) && isfinite(y) && (!plane->y.is_log || y > 0);
        if (is_there && series->has_rings)
            canvas_circle(canvas, plane_x(plane, x), plane_y(plane, y), 1.9);
        else if (is_there && is_open) cairo_line_to(cr, plane_x(plane, x), plane_y(plane, y));
        else if (is_there) cairo_move_to(cr, plane_x(plane, x), plane_y(plane, y));
        is_open = is_there;
    }
    canvas_stroke(canvas, series->stroke);
    cairo_restore(cr);
}

static void draw_key(const ChartPlane *plane, const Chart *chart) {
    double x = plane->plot.x + plane->plot.w + 8, y = plane->plot.y + 6;
    for (int i = 0; i < chart->series_count; i++) {
        const Series *series = &chart->series[i];
        if (!series->is_key) continue;
        if (series->has_rings) canvas_circle(plane->canvas, x + 8, y, 1.9);
        else cairo_move_to(plane->canvas->cr, x, y), cairo_line_to(plane->canvas->cr, x + 16, y);
        canvas_stroke(plane->canvas, series->stroke);
        canvas_text(
            plane->canvas, x + 20, y, (Letters){.size = SIZE_SMALL, .ink = INK_TEXT, .down = 0.5},
            canvas_fit_text(plane->canvas, SIZE_SMALL, false, KEY_WIDTH - 30, series->name));
        y += KEY_LEADING;
    }
}

static void draw_axes(Canvas *canvas, Box box, const Chart *chart) {
    ChartPlane plane = {canvas, box, with_extent(chart->x), with_extent(chart->y)};
    double left = 0, top = 22, bottom = 34, right = 14;
    Ticks ticks = axis_ticks(&plane.y, box.h - top - bottom, 26);
    for (int i = 0; i < ticks.count; i++)
        if (ticks.is_labelled[i])
            left = fmax(left, canvas_text_width(canvas, SIZE_TICK, false,
                                                label_of(canvas, &plane.y, &ticks, i)));
    for (int i = 0; i < chart->series_count; i++)
        if (chart->series[i].is_key) right = KEY_WIDTH;
    plane.plot =
        (Box){box.x + left + 9, box.y + top, box.w - left - 9 - right, box.h - top - bottom};
    if (chart->is_square) make_square(&plane);
    draw_grid(&plane, box, chart);
    for (int side = 0; side < 2; side++) {
        double at = fmin(fmax(chart->measured[side], plane.x.low), plane.x.high);
        double from = plane_x(&plane, side ? at : plane.x.low);
        double to = plane_x(&plane, side ? plane.x.high : at);
        if (to > from) canvas_hatch(canvas, (Box){from, plane.plot.y, to - from, plane.plot.h});
    }
    for (int i = 0; i < chart->series_count; i++) draw_series(&plane, chart, &chart->series[i]);
    draw_key(&plane, chart);
}

/* ---- colours ----------------------------------------------------------------------------- */

#define SCALE_WIDTH 62.0

/* A chart whose values are colours, on the page. */
typedef struct Paint {
    Canvas *canvas;
    const Chart *chart;
    ChartAxis scale;
    uint32_t palette[AMOUNTS], nothing;
    double x, y, radius; /* of a disc */
    int side;            /* of its raster, pixels */
} Paint;

static uint32_t pixel_of(const Paint *paint, double value) {
    if (!isfinite(value)) return paint->nothing;
    double t = fmin(fmax(position(&paint->scale, value), 0), 1);
    return paint->palette[(int)((AMOUNTS - 1) * t + 0.5)];
}

static uint32_t scale_pixel(const void *context, int column, int row) {
    (void)column;
    return ((const Paint *)context)->palette[AMOUNTS - 1 - row];
}

/* The ticks of the scale, where lines of equal value are drawn too. */
static Ticks scale_ticks(const Paint *paint, double height) {
    return axis_ticks(&paint->scale, height, 22);
}

static void draw_scale(const Paint *paint, Box bar) {
    Canvas *canvas = paint->canvas;
    Ticks ticks = scale_ticks(paint, bar.h);
    canvas_image(canvas, bar, &(CanvasRaster){1, AMOUNTS, true, scale_pixel, paint});
    for (int i = 0; i < ticks.count; i++) {
        if (!ticks.is_labelled[i]) continue;
        double y = bar.y + bar.h * (1 - position(&paint->scale, ticks.value[i]));
        canvas_line(canvas, bar.x + bar.w, y, bar.x + bar.w + 3, y,
                    (Stroke){INK_SOFT, 0.8, DASH_NONE});
        canvas_text(canvas, bar.x + bar.w + 6, y,
                    (Letters){.size = SIZE_TICK, .ink = INK_SOFT, .down = 0.5},
                    label_of(canvas, &paint->scale, &ticks, i));
    }
    canvas_text(canvas, bar.x, bar.y - 8, (Letters){.size = SIZE_TICK, .ink = INK_TEXT, .down = 1},
                paint->chart->table->kind->columns[2].words);
}

/* ---- over the hemisphere ----------------------------------------------------------------- */

#define LABEL_ROOM 26.0
#define LINE_LEAST 0.02 /* of the scale from its ends: nearer lines show nothing */

static double polar_cell(const Paint *paint, int ring, int azimuth) {
    return chart_cell(paint->chart, ring * CHART_PHIS + azimuth % CHART_PHIS, 2);
}

/* Bilinear; x, y in radii from the middle, up. */
static double polar_value(const Paint *paint, double x, double y) {
    double at = fmin(hypot(x, y), 1) * (CHART_THETAS - 1), turn = atan2(y, x) / (2 * PI);
    double along = (turn - floor(turn)) * CHART_PHIS;
    int ring = (int)fmin(at, CHART_THETAS - 2), azimuth = (int)along;
    double f = at - ring, g = along - azimuth, sum = 0;
    for (int k = 0; k < 4; k++) {
        double weight = (k & 1 ? f : 1 - f) * (k & 2 ? g : 1 - g);
        if (weight > 0) sum += weight * polar_cell(paint, ring + (k & 1), azimuth + (k >> 1));
    }
    return sum;
}

static uint32_t disc_pixel(const void *context, int column, int row) {
    const Paint *paint = context;
    double x = 2 * (column + 0.5) / paint->side - 1, y = 1 - 2 * (row + 0.5) / paint->side;
    return pixel_of(paint, polar_value(paint, x, y));
}

/* A cell's corners in order; where the level crosses its edges, points of the page. */
static int crossings(const Paint *paint, int ring, int azimuth, double level, double at[4][2]) {
    double value[4], x[4], y[4];
    int count = 0;
    for (int k = 0; k < 4; k++) {
        int i = ring + (k == 1 || k == 2), j = azimuth + (k >= 2);
        double r = paint->radius * i / (CHART_THETAS - 1), a = 2 * PI * j / CHART_PHIS;
        value[k] = polar_cell(paint, i, j) - level;
        x[k] = paint->x + r * cos(a);
        y[k] = paint->y - r * sin(a);
        if (!isfinite(value[k])) return 0;
    }
    for (int k = 0; k < 4; k++) {
        int next = (k + 1) % 4;
        if ((value[k] >= 0) == (value[next] >= 0)) continue;
        double f = value[k] / (value[k] - value[next]);
        at[count][0] = x[k] + f * (x[next] - x[k]);
        at[count++][1] = y[k] + f * (y[next] - y[k]);
    }
    return count;
}

/* A line of equal value, cell by cell. */
static void draw_level(const Paint *paint, double level, Stroke stroke) {
    cairo_t *cr = paint->canvas->cr;
    for (int ring = 0; ring + 1 < CHART_THETAS; ring++)
        for (int azimuth = 0; azimuth < CHART_PHIS; azimuth++) {
            double at[4][2];
            int count = crossings(paint, ring, azimuth, level, at);
            for (int k = 0; k + 1 < count; k += 2) { /* four at a saddle: two pieces */
                cairo_move_to(cr, at[k][0], at[k][1]);
                cairo_line_to(cr, at[k + 1][0], at[k + 1][1]);
            }
        }
    canvas_stroke(paint->canvas, stroke);
}

static void draw_levels(const Paint *paint, double height) {
    Ticks ticks = scale_ticks(paint, height);
    for (int i = 0; i < ticks.count; i++) {
        double t = position(&paint->scale, ticks.value[i]);
        if (ticks.is_labelled[i] && t > LINE_LEAST && t < 1 - LINE_LEAST)
            draw_level(paint, ticks.value[i],
                       (Stroke){ink_alpha(ink_on_amount(t), 0.7), 0.8, DASH_NONE});
    }
    if (isfinite(paint->chart->strong))
        draw_level(
            paint, paint->chart->strong,
            (Stroke){ink_on_amount(position(&paint->scale, paint->chart->strong)), 1.8, DASH_NONE});
}

static void draw_angles(const Paint *paint) {
    Canvas *canvas = paint->canvas;
    Stroke thin = {ink_alpha(ink_hex(0x808890), 0.6), 0.5, DASH_NONE};
    double towards = -0.375 * PI; /* where the rings' degrees stand */
    for (int deg = 20; deg < 90; deg += 20) {
        double r = paint->radius * deg / 90;
        canvas_circle(canvas, paint->x, paint->y, r);
        canvas_stroke(canvas, thin);
        canvas_text(
            canvas, paint->x + r * cos(towards), paint->y - r * sin(towards),
            (Letters){
                .size = SIZE_SMALL, .ink = INK_TEXT, .across = 0.5, .down = 0.5, .halo = INK_PAPER},
            arena_format(canvas->arena, "%d°", deg));
    }
    for (int deg = 0; deg < 360; deg += 45) {
        double x = cos(radians_from_degrees(deg)), y = -sin(radians_from_degrees(deg));
        canvas_line(canvas, paint->x, paint->y, paint->x + paint->radius * x,
                    paint->y + paint->radius * y, thin);
        canvas_text(canvas, paint->x + (paint->radius + 5) * x, paint->y + (paint->radius + 5) * y,
                    (Letters){.size = SIZE_SMALL,
                              .ink = INK_SOFT,
                              .across = 0.5 - 0.5 * x,
                              .down = 0.5 - 0.5 * y},
                    arena_format(canvas->arena, "%d°", deg));
    }
    canvas_circle(canvas, paint->x, paint->y, paint->radius);
    canvas_stroke(canvas, (Stroke){INK_FAINT, 0.9, DASH_NONE});
}

static void hatch_rim(const Paint *paint) {
    cairo_t *cr = paint->canvas->cr;
    double r = paint->radius, from = paint->chart->measured[1] / 90 * r;
    if (from >= r - 0.5) return;
    cairo_save(cr);
    canvas_circle(paint->canvas, paint->x, paint->y, r);
    cairo_new_sub_path(cr);
    cairo_arc_negative(cr, paint->x, paint->y, from, 2 * PI, 0);
    cairo_clip(cr);
    canvas_hatch(paint->canvas, (Box){paint->x - r, paint->y - r, 2 * r, 2 * r});
    cairo_restore(cr);
    canvas_circle(paint->canvas, paint->x, paint->y, from);
    canvas_stroke(paint->canvas, (Stroke){INK_TEXT, 0.8, DASH_SHORT});
}

static void draw_polar(Paint *paint, Box box) {
    double across = box.w - SCALE_WIDTH - 2 * LABEL_ROOM - 6, down = box.h - 34;
    double r = paint->radius = fmin(across, down) / 2, height = fmin(1.55 * r, 2 * r - 20);
    paint->x = box.x + (box.w - 2 * r - 2 * LABEL_ROOM - 6 - SCALE_WIDTH) / 2 + LABEL_ROOM + r;
    paint->y = box.y + box.h / 2;
    paint->side = (int)fmin(2 * r * paint->canvas->pixels_per_point, 1400);
    cairo_save(paint->canvas->cr);
    canvas_circle(paint->canvas, paint->x, paint->y, r);
    cairo_clip(paint->canvas->cr);
    canvas_image(paint->canvas, (Box){paint->x - r, paint->y - r, 2 * r, 2 * r},
                 &(CanvasRaster){paint->side, paint->side, false, disc_pixel, paint});
    cairo_restore(paint->canvas->cr);
    if (!paint->chart->has_no_lines) draw_levels(paint, height);
    hatch_rim(paint);
    draw_angles(paint);
    draw_scale(paint, (Box){paint->x + r + LABEL_ROOM + 6, paint->y - height / 2 + 6, 10, height});
}

/* ---- over a display ---------------------------------------------------------------------- */

static uint32_t area_pixel(const void *context, int column, int row) {
    const Paint *paint = context;
    return pixel_of(paint, chart_cell(paint->chart, row * CHART_COLUMNS + column, 2));
}

static void draw_area(const Paint *paint, Box box) {
    Canvas *canvas = paint->canvas;
    Box area = {box.x, box.y + 24, box.w - SCALE_WIDTH - 12, 0};
    area.h = area.w / paint->chart->ratio;
    if (area.h > box.h - 32) area.h = box.h - 32, area.w = area.h * paint->chart->ratio;
    canvas_image(canvas, area, &(CanvasRaster){CHART_COLUMNS, CHART_ROWS, true, area_pixel, paint});
    for (int i = 0; i < paint->chart->mark_count; i++) {
        const ChartMark *mark = &paint->chart->mark[i];
        double x = area.x + mark->u * area.w, y = area.y + mark->v * area.h;
        char text[32];
        if (isfinite(mark->value)) {
            canvas_text(canvas, x, y,
                        (Letters){.size = SIZE_TICK,
                                  .ink = ink_on_amount(position(&paint->scale, mark->value)),
                                  .across = 0.5,
                                  .down = 0.5},
                        figure_text(mark->value, text));
            continue;
        }
        canvas_circle(canvas, x, y, 13);
        canvas_stroke(canvas, (Stroke){INK_PAPER, 0.9, DASH_NONE});
    }
    draw_scale(paint, (Box){area.x + area.w + 10, area.y, 10, area.h});
}

void chart_draw(Canvas *canvas, Box box, const Chart *chart) {
    if (chart->kind == CHART_AXES) {
        draw_axes(canvas, box, chart);
        return;
    }
    Paint paint = {
        .canvas = canvas, .chart = chart, .scale = with_extent(chart->y), .nothing = 0xffd8dcdf};
    amount_palette(paint.palette);
    if (chart->kind == CHART_POLAR) draw_polar(&paint, box);
    else draw_area(&paint, box);
}
