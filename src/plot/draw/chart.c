/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/chart.h"

#include <math.h>
#include <stdlib.h>

#include "plot/draw/ticks.h"

#define NAME_LEADING 12.5

static double position(const AxisSpec *axis, double value) {
    if (!axis->is_log) return (value - axis->low) / (axis->high - axis->low);
    return value > 0 ? log(value / axis->low) / log(axis->high / axis->low) : -9;
}

double chart_x(const Chart *chart, double value) {
    return chart->plot.x + chart->plot.w * position(&chart->x, value);
}

double chart_y(const Chart *chart, double value) {
    return chart->plot.y + chart->plot.h * (1 - position(&chart->y, value));
}

static Ticks axis_ticks(const AxisSpec *axis, double length, double room) {
    int most = (int)(length / room);
    most = most < 2 ? 2 : most > 10 ? 10 : most;
    if (axis->is_log) return ticks_log(axis->low, axis->high, most);
    if (axis->step > 0 && (axis->high - axis->low) / axis->step <= most)
        return ticks_every(axis->step, axis->low, axis->high);
    if (axis->step > 0 && (axis->high - axis->low) / axis->step / 2 <= most)
        return ticks_every(2 * axis->step, axis->low, axis->high);
    return ticks_linear(axis->low, axis->high, most);
}

static const char *label_of(Canvas *canvas, const AxisSpec *axis, const Ticks *ticks, int i) {
    char text[32];
    tick_text(ticks->value[i], axis->is_log ? 0 : ticks->step, text);
    return arena_format(canvas->arena, "%s%s", text, axis->suffix ? axis->suffix : "");
}

static double widest_label(Canvas *canvas, const AxisSpec *axis, const Ticks *ticks) {
    double widest = 0;
    for (int i = 0; i < ticks->count; i++)
        if (ticks->is_labelled[i])
            widest = fmax(widest, canvas_text_width(canvas, SIZE_TICK, false,
                                                    label_of(canvas, axis, ticks, i)));
    return widest;
}

static void draw_x_axis(Chart *chart, const Ticks *ticks) {
    Canvas *canvas = chart->canvas;
    Box p = chart->plot;
    for (int i = 0; i < ticks->count; i++) {
        double x = chart_x(chart, ticks->value[i]), length = ticks->is_labelled[i] ? 4 : 2.5;
        if (ticks->is_labelled[i])
            canvas_line(canvas, x, p.y, x, p.y + p.h, (Stroke){canvas->theme.grid, 0.8, 0});
        canvas_line(canvas, x, p.y + p.h, x, p.y + p.h + length,
                    (Stroke){canvas->theme.faint, 0.8, DASH_NONE});
        if (ticks->is_labelled[i])
            canvas_text(canvas, x, p.y + p.h + 7,
                        (Letters){.size = SIZE_TICK, .ink = canvas->theme.soft, .across = 0.5},
                        label_of(canvas, &chart->x, ticks, i));
    }
    canvas_text(canvas, p.x + p.w, p.y + p.h + 21,
                (Letters){.size = SIZE_TICK, .ink = canvas->theme.ink, .across = 1},
                chart->x.title);
}

static void draw_y_axis(Chart *chart, const Ticks *ticks) {
    Canvas *canvas = chart->canvas;
    Box p = chart->plot;
    for (int i = 0; i < ticks->count; i++) {
        double y = chart_y(chart, ticks->value[i]);
        if (!ticks->is_labelled[i]) {
            canvas_line(canvas, p.x - 2.5, y, p.x, y,
                        (Stroke){canvas->theme.faint, 0.8, DASH_NONE});
            continue;
        }
        canvas_line(canvas, p.x - 4, y, p.x + p.w, y, (Stroke){canvas->theme.grid, 0.8, 0});
        canvas_text(
            canvas, p.x - 7, y,
            (Letters){.size = SIZE_TICK, .ink = canvas->theme.soft, .across = 1, .down = 0.5},
            label_of(canvas, &chart->y, ticks, i));
    }
    canvas_text(canvas, chart->box.x, p.y - 10,
                (Letters){.size = SIZE_TICK, .ink = canvas->theme.ink, .down = 1}, chart->y.title);
}

/* Data without any spread still get an axis. */
static AxisSpec with_extent(AxisSpec axis) {
    if (axis.is_log && !(axis.high > 0)) axis.high = 1;
    if (axis.is_log && !(axis.low > 0 && axis.low < axis.high)) axis.low = axis.high / 10;
    if (!axis.is_log && !(axis.high > axis.low)) axis.high = axis.low + 1;
    return axis;
}

Chart chart_open(Canvas *canvas, Box box, AxisSpec x, AxisSpec y, double right) {
    x = with_extent(x);
    y = with_extent(y);
    Chart chart = {.canvas = canvas, .box = box, .x = x, .y = y};
    double top = 22, bottom = 34;
    Ticks y_ticks = axis_ticks(&y, box.h - top - bottom, 26);
    double left = widest_label(canvas, &y, &y_ticks) + 9;
    chart.plot = (Box){box.x + left, box.y + top, box.w - left - right, box.h - top - bottom};
    Ticks x_ticks = axis_ticks(&x, chart.plot.w, x.is_log ? 30 : 38);
    draw_y_axis(&chart, &y_ticks);
    draw_x_axis(&chart, &x_ticks);
    canvas_line(canvas, chart.plot.x, chart.plot.y + chart.plot.h, chart.plot.x + chart.plot.w,
                chart.plot.y + chart.plot.h, (Stroke){canvas->theme.faint, 0.9, DASH_NONE});
    return chart;
}

static void clip_to_plot(Chart *chart) {
    Box p = chart->plot;
    cairo_save(chart->canvas->cr);
    cairo_rectangle(chart->canvas->cr, p.x - 1, p.y - 1, p.w + 2, p.h + 2);
    cairo_clip(chart->canvas->cr);
}

void chart_curve(Chart *chart, const double *x, const double *y, int count, Stroke stroke) {
    Arena scratch = *chart->canvas->arena;
    double *px = ARENA_NEW(&scratch, double, count), *py = ARENA_NEW(&scratch, double, count);
    Canvas canvas = *chart->canvas;
    int length = 0;
    canvas.arena = &scratch;
    clip_to_plot(chart);
    for (int i = 0; i <= count; i++) {
        bool ok = i < count && isfinite(x[i]) && isfinite(y[i]) && (!chart->y.is_log || y[i] > 0) &&
                  (!chart->x.is_log || x[i] > 0);
        if (ok) {
            px[length] = chart_x(chart, x[i]);
            py[length++] = chart_y(chart, y[i]);
        } else {
            canvas_polyline(&canvas, px, py, length);
            length = 0;
        }
    }
    canvas_stroke(&canvas, stroke);
    cairo_restore(canvas.cr);
}

void chart_name(Chart *chart, double x, double y, Ink ink, const char *text) {
    if (chart->name_count == CURVE_NAMES_MAX) return;
    Box p = chart->plot;
    double at = fmin(fmax(chart_y(chart, y), p.y), p.y + p.h);
    chart->name[chart->name_count++] = (CurveName){text, chart_x(chart, x), at, ink};
}

void chart_name_curve(Chart *chart, const double *x, const double *y, int count, Ink ink,
                      const char *text) {
    for (int i = count - 1; i >= 0; i--) {
        if (!isfinite(y[i]) || !(x[i] <= chart->x.high)) continue;
        double at = chart_y(chart, y[i]);
        if (i > 0 && !(at >= chart->plot.y - 1 && at <= chart->plot.y + chart->plot.h + 1))
            continue;
        chart_name(chart, x[i], y[i], ink, text);
        return;
    }
}

void chart_dot(Chart *chart, double x, double y, double radius, Ink ink) {
    if (!isfinite(y) || (chart->y.is_log && !(y > 0))) return;
    double px = chart_x(chart, x), py = chart_y(chart, y);
    Box p = chart->plot;
    if (px < p.x - 1 || px > p.x + p.w + 1 || py < p.y - 1 || py > p.y + p.h + 1) return;
    cairo_new_sub_path(chart->canvas->cr);
    cairo_arc(chart->canvas->cr, px, py, radius, 0, 2 * 3.14159265358979);
    canvas_fill(chart->canvas, ink);
}

void chart_mark_x(Chart *chart, double x, Stroke stroke, const char *text) {
    Box p = chart->plot;
    double at = chart_x(chart, x);
    if (at < p.x || at > p.x + p.w) return;
    canvas_line(chart->canvas, at, p.y, at, p.y + p.h, stroke);
    bool is_right = at > p.x + 0.6 * p.w;
    canvas_text(chart->canvas, at + (is_right ? -4 : 4), p.y + 3,
                (Letters){.size = SIZE_SMALL,
                          .ink = stroke.ink,
                          .across = is_right,
                          .halo = chart->canvas->theme.paper},
                text);
}

void chart_hatch(Chart *chart, double x0, double x1) {
    double low = fmax(x0, chart->x.low), high = fmin(x1, chart->x.high);
    if (!(high > low)) return;
    double left = chart_x(chart, low);
    canvas_hatch(chart->canvas,
                 (Box){left, chart->plot.y, chart_x(chart, high) - left, chart->plot.h});
}

static int compare_names(const void *a, const void *b) {
    double y = ((const CurveName *)a)->y, z = ((const CurveName *)b)->y;
    return (y > z) - (y < z);
}

/* Pushes neighbours apart, evenly to both sides, and all of them into the plot's height. */
static void spread_names(Chart *chart, double at[CURVE_NAMES_MAX]) {
    int n = chart->name_count;
    double low = chart->plot.y + 4, high = chart->plot.y + chart->plot.h - 4;
    double leading = fmin(NAME_LEADING, n > 1 ? (high - low) / (n - 1) : NAME_LEADING);
    for (int i = 0; i < n; i++) at[i] = chart->name[i].y;
    for (int round = 0; round < 200; round++) {
        for (int i = 0; i + 1 < n; i++) {
            double overlap = leading - (at[i + 1] - at[i]);
            if (overlap <= 0) continue;
            at[i] -= overlap / 2;
            at[i + 1] += overlap / 2;
        }
        for (int i = 0; i < n; i++)
            at[i] = fmin(fmax(at[i], low + i * leading), high - (n - 1 - i) * leading);
    }
}

void chart_close(Chart *chart) {
    double at[CURVE_NAMES_MAX], right = chart->plot.x + chart->plot.w;
    qsort(chart->name, (size_t)chart->name_count, sizeof *chart->name, compare_names);
    spread_names(chart, at);
    for (int i = 0; i < chart->name_count; i++) {
        const CurveName *name = &chart->name[i];
        double from = fmin(name->x, right) + 2;
        cairo_move_to(chart->canvas->cr, from, name->y);
        cairo_curve_to(chart->canvas->cr, from + 5, name->y, right + 2, at[i], right + 8, at[i]);
        canvas_stroke(chart->canvas, (Stroke){ink_alpha(name->ink, 0.6), 0.7, DASH_NONE});
        canvas_text(chart->canvas, right + 10, at[i],
                    (Letters){.size = SIZE_TICK, .ink = name->ink, .down = 0.5}, name->text);
    }
}
