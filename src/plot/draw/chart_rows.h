/* SPDX-License-Identifier: Apache-2.0 */
/* chart_rows.h -- a chart as what it shows: series over two axes, a quantity over the
 * hemisphere, or one over the display. A drawer fills them; one function draws each kind, and
 * the same rows are written as numbers.
 *
 * Units    the axes' own; offsets and widths in points of the page.
 * Memory   the arena's. Threads: one thread a canvas.
 */
#pragma once
#include "plot/draw/chart.h"
#include "plot/draw/polar.h"

/* Drawn in the order in which they were added. */
typedef enum SeriesKind {
    SERIES_CURVE,
    SERIES_DOTS,  /* of radius stroke.width */
    SERIES_RINGS, /* likewise, 0.8 wide */
    SERIES_AREA,  /* from the curve down to the axis */
    SERIES_BARS,  /* y[i] high from x[i] to x[i + 1]: x has one more */
    SERIES_HATCH, /* x from at[0] to at[1]: not measured */
    SERIES_LINE,  /* across the plot at x = at[0], with its label */
    SERIES_WORD   /* a label at `at` */
} SeriesKind;

/* Where a label would cover the word before it. */
typedef enum SeriesCrowd { CROWD_NOTHING, CROWD_GOES_DOWN, CROWD_IS_LEFT_OUT } SeriesCrowd;

typedef struct ChartPoints {
    int count;
    double *x, *y;
} ChartPoints;

typedef struct Series {
    SeriesKind kind;
    const char *name; /* among the numbers; NULL: not there */
    Stroke stroke;
    ChartPoints points;
    const bool *is_pale; /* of a curve: extrapolated there; NULL: nowhere */
    const char *label;   /* beside the curve; NULL: none */
    int label_index;     /* the point that it is beside; 0: where the curve is last seen */
    bool is_key;         /* the label stands in the key instead */
    double at[2];
    double dx, dy, across; /* of a word: off `at`; as Letters. It stands on its place */
    SeriesCrowd crowd;
} Series;

#define SERIES_MAX 64

typedef enum KeyCorner { KEY_UPPER_LEFT, KEY_LOWER_LEFT, KEY_LOWER_RIGHT } KeyCorner;

typedef enum ChartKind { CHART_PLAIN, CHART_POLAR, CHART_AXES } ChartKind;

/* A quantity over the display's active area, with what is written on it. */
typedef struct CellMap {
    int columns, rows;
    float *value;
    ColourMap map;
    double low, high; /* of the colours; high <= low: all have the middle one */
    bool is_log;
    double ratio;         /* width over height */
    const char *scale[3]; /* beside the colours: top, middle, bottom */
    int lines[2];         /* across and down, as many parts; 0: none */
    int figure_count, ring_count;
    const float (*figure)[2]; /* places {u, v} with their values written there */
    const double *figure_value;
    const float (*ring)[2]; /* places that are marked */
    const char *unit;
} CellMap;

typedef struct ChartRows {
    ChartKind kind;
    const Theme *theme; /* for inks */
    Arena *arena;
    AxisSpec x, y;
    double right;                  /* room for labels beside the curves */
    bool is_square;                /* a unit is as long on both axes */
    void (*ground)(const Chart *); /* drawn under the series; NULL: nothing */
    KeyCorner key;                 /* of labels with is_key, those of the last series first */
    int count;
    Series series[SERIES_MAX];
    PolarMap polar;
    CellMap cells; /* of CHART_PLAIN */
} ChartRows;

/* Where the values of a drawn chart lie, for a read-out under the pointer: points of the box's
 * page. */
typedef struct ChartMap {
    ChartKind kind;
    PolarPlace disc;
    Box plot; /* the axes' rectangle */
    double low[2], high[2];
} ChartMap;

/* So many points, to be filled. */
ChartPoints chart_rows_points(const ChartRows *rows, int count);

/* Add a series, which must find room: one of points; from x0 to x1 nothing was measured; a line
 * at x; a word. What they return is good until the next one is added. */
Series *chart_rows_add(ChartRows *rows, SeriesKind kind, const char *name, Stroke stroke,
                       ChartPoints points);
void chart_rows_hatch(ChartRows *rows, double x0, double x1);
void chart_rows_line(ChartRows *rows, double x, Stroke stroke, const char *label);
Series *chart_rows_word(ChartRows *rows, double x, double y, Ink ink, const char *label);

ChartMap chart_rows_draw(Canvas *canvas, Box box, const ChartRows *rows);
