/* SPDX-License-Identifier: Apache-2.0 */
/* chart.h -- curves over an axis: frame, grid, ticks, curves with their names beside them.
 *
 * Units    an axis has its own unit; boxes are in points of the page.
 * Memory   lists of names come from the canvas's arena.
 * Threads  one thread a chart.
 */
#pragma once
#include "plot/draw/canvas.h"

typedef struct AxisSpec {
    double low, high;
    bool is_log;
    const char *title;  /* "Luminance, cd/m²" */
    double step;        /* between ticks; 0: chosen */
    const char *suffix; /* behind every tick's number: "°"; NULL: none */
} AxisSpec;

static inline AxisSpec axis_even(double low, double high, const char *title) {
    return (AxisSpec){.low = low, .high = high, .title = title};
}

static inline AxisSpec axis_log(double low, double high, const char *title) {
    return (AxisSpec){.low = low, .high = high, .is_log = true, .title = title};
}

typedef struct CurveName {
    const char *text;
    double x, y; /* where the curve ends, points */
    Ink ink;
} CurveName;

#define CURVE_NAMES_MAX 24

typedef struct Chart {
    Canvas *canvas;
    Box box;  /* the whole figure */
    Box plot; /* where the curves are */
    AxisSpec x, y;
    int name_count;
    CurveName name[CURVE_NAMES_MAX];
} Chart;

/* Draws grid and axes. right: room for the curves' names, points. */
Chart chart_open(Canvas *canvas, Box box, AxisSpec x, AxisSpec y, double right);

/* To points; logarithms of nothing are far outside. */
double chart_x(const Chart *chart, double value);
double chart_y(const Chart *chart, double value);

/* A curve; values that are not finite interrupt it. */
void chart_curve(Chart *chart, const double *x, const double *y, int count, Stroke stroke);

/* The curve's name at the right of the plot, beside (x, y) of the axes. */
void chart_name(Chart *chart, double x, double y, Ink ink, const char *text);

/* Where the curve is last seen inside the plot: the name goes there. */
void chart_name_curve(Chart *chart, const double *x, const double *y, int count, Ink ink,
                      const char *text);

void chart_dot(Chart *chart, double x, double y, double radius, Ink ink);
/* A line across the plot at a value, with a word on it. */
void chart_mark_x(Chart *chart, double x, Stroke stroke, const char *text);

/* From x0 to x1 nothing was measured. */
void chart_hatch(Chart *chart, double x0, double x1);

/* Writes the names, spread so that none covers another. */
void chart_close(Chart *chart);
