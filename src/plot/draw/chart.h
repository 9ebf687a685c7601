/* SPDX-License-Identifier: Apache-2.0 */
/* chart.h -- a table as a picture. What is drawn is the rows of the chart's table:
 *
 *   CHART_AXES   name, x, y              curves and rings over two axes, a series' rows together
 *   CHART_POLAR  theta_deg, phi_deg, ... a quantity over the hemisphere: CHART_THETAS rings of
 *                                        CHART_PHIS azimuths, from the normal outwards
 *   CHART_AREA   u, v, ...               a quantity over a display: CHART_ROWS rows of
 *                                        CHART_COLUMNS places, from the upper left
 *
 * Frame    the disc as one sees the display: phi counter-clockwise from the right.
 * Units    the columns'; boxes in points of the page. NaN: nothing there.
 * Memory   the chart's arena. Threads: one at a time a chart.
 */
#pragma once
#include "plot/draw/canvas.h"
#include "table/table.h"

typedef enum ChartKind { CHART_AXES, CHART_POLAR, CHART_AREA } ChartKind;

#define CHART_THETAS 91 /* a degree apart */
#define CHART_PHIS 120
#define CHART_COLUMNS 96
#define CHART_ROWS 54

/* An axis; of a quantity over the hemisphere or a display its colours. */
typedef struct ChartAxis {
    double low, high; /* without any spread: widened */
    bool is_log;
    double step;        /* between ticks; 0: chosen */
    const char *suffix; /* behind every tick's number: "°"; NULL: none */
} ChartAxis;

typedef struct Series {
    const char *name;
    int first, count; /* rows of the table */
    bool has_rings;   /* in place of a curve */
    Stroke stroke;
    bool is_key; /* stands in the key */
} Series;

/* A place of an area: a ring, and the value written there where there is one. */
typedef struct ChartMark {
    double u, v, value;
} ChartMark;

#define SERIES_MAX 32
#define MARKS_MAX 64

typedef struct Chart {
    ChartKind kind;
    const char *title, *subtitle;
    const char *caption; /* what one sees, with units */
    Table *table;
    ChartAxis x, y;     /* y: also the colours */
    double measured[2]; /* of x, or theta in degrees up to [1]: beyond is hatched */
    bool is_square;     /* a unit is as long on both axes */
    int series_count, mark_count;
    Series series[SERIES_MAX];
    ChartMark mark[MARKS_MAX];
    bool has_no_lines; /* of equal value, over the hemisphere, at the scale's numbers */
    double strong;     /* one that is drawn strongly; NaN: none */
    double ratio;      /* of an area: width over height */
} Chart;

/* Nothing is hatched yet. x: of axes that one's name with its unit, else NULL; value: the other
 * axis's name likewise, or the unit of the colours. */
Chart *chart_new(ChartKind kind, const char *title, const char *x, const char *value, Arena *arena);

/* A series, whose rows follow; good until the next one. Then a row of the last one. */
Series *chart_series(Chart *chart, const char *name, Stroke stroke);
void chart_point(Chart *chart, double x, double y);

/* All rows of a chart over the hemisphere (a: theta, b: phi, radians), or over a display (a: u,
 * b: v). */
typedef double ChartQuantity(const void *context, double a, double b);
void chart_fill(Chart *chart, ChartQuantity *quantity, const void *context);

/* A cell of a row; its last column is 2. */
double chart_cell(const Chart *chart, int row, int column);

/* Of the last column, over all rows whose theta is no more than a limit in degrees; values that
 * are not finite do not count. None: low and high are 0. */
typedef struct ChartRange {
    double low, high;
    int highest; /* row */
} ChartRange;

ChartRange chart_range(const Chart *chart, double theta_deg);

void chart_draw(Canvas *canvas, Box box, const Chart *chart);
