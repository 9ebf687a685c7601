/* SPDX-License-Identifier: Apache-2.0 */
/* panel_chart.h -- the charts that a panel gives, and how each is drawn into a box.
 *
 * Units    points of the page.
 * Memory   the arena's. Threads: one thread a canvas.
 */
#pragma once
#include "plot/draw/chart.h"
#include "plot/draw/polar.h"
#include "plot/panel/plot_data.h"

struct PanelChart;

/* Where the values of a drawn chart lie, for a read-out under the pointer: points of the box's
 * page. */
typedef struct PanelChartMap {
    enum { PANEL_CHART_PLAIN, PANEL_CHART_POLAR, PANEL_CHART_AXES } kind;
    PolarPlace disc;
    Field field; /* polar: the values */
    const char *unit;
    Box plot; /* chart: the axes' rectangle */
    double low[2], high[2];
    bool is_log[2];
    const char *axis[2];
} PanelChartMap;

typedef enum SheetRole {
    SHEET_NEVER,
    SHEET_SPARE,
    SHEET_ALWAYS /* spare: where a row of the sheet has room left */
} SheetRole;

typedef void PanelChartDraw(Canvas *canvas, Box box, const struct PanelChart *chart,
                            PanelChartMap *map);

typedef struct PanelChart {
    PlotKind kind;
    const char *title;
    const char *subtitle; /* "" or one line of small letters */
    const char *caption;  /* for the report: what one sees, with units */
    PanelChartDraw *draw;
    const PlotData *data;
    int index; /* which pattern, which section: the drawer's own */
    SheetRole role;
    bool needs_primaries; /* means nothing without measured primaries and levels */
} PanelChart;

#define PANEL_CHARTS_MAX 48

typedef struct PanelChartList {
    int count;
    PanelChart chart[PANEL_CHARTS_MAX];
} PanelChartList;

/* The charts of some kinds: `add` adds those that the data allow. */
typedef struct PanelCharts {
    PlotKind first, last;
    void (*add)(PanelChartList *list, const PlotData *data);
} PanelCharts;

/* Each in the file of its name. */
extern const PanelCharts emission_charts, curve_charts, angle_charts, colour_charts,
    reflection_charts, fit_charts, place_charts, halo_charts;

/* A chart of primaries or levels of a set that is white only states so and leaves the
 * sheet. */
void panel_chart_add(PanelChartList *list, const PanelChart *chart);

/* The ink at t of a map's colours. */
Ink panel_chart_ink(ColourMap map, double t);

/* The ink of the i-th of so many curves that stand in an order. */
Ink panel_chart_series_ink(const Canvas *canvas, int i, int count);

/* Title, subtitle and the chart itself. */
void panel_chart_draw(Canvas *canvas, Box box, const PanelChart *chart, PanelChartMap *map);

/* Draws a polar map, and notes where it lies. */
void panel_chart_polar(Canvas *canvas, Box box, const PolarMap *polar, PanelChartMap *map);

/* Over angles in degrees: beyond the cone (radians) on both sides nothing was measured. */
void panel_chart_hatch(Chart *chart, double cone);

/* Notes the axes of a finished chart. */
void panel_chart_map_axes(PanelChartMap *map, const Chart *chart);
