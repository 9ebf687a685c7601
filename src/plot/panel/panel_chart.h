/* SPDX-License-Identifier: Apache-2.0 */
/* panel_chart.h -- the charts that a panel gives, and what each shows.
 *
 * Units    points of the page.
 * Memory   the arena's. Threads: one thread a canvas.
 */
#pragma once
#include "plot/draw/chart_rows.h"
#include "plot/panel/plot_data.h"

struct PanelChart;

typedef enum SheetRole {
    SHEET_NEVER,
    SHEET_SPARE,
    SHEET_ALWAYS /* spare: where a row of the sheet has room left */
} SheetRole;

/* Sets the kind, the axes and what stands over them; theme and arena are there. */
typedef void PanelChartFill(const struct PanelChart *chart, ChartRows *out);

typedef struct PanelChart {
    PlotKind kind;
    const char *title;
    const char *subtitle; /* "" or one line of small letters */
    const char *caption;  /* for the report: what one sees, with units */
    PanelChartFill *fill;
    const PlotData *data;
    int index; /* which pattern, which section: the filler's own */
    SheetRole role;
    bool needs_primaries; /* means nothing without measured primaries and levels */
} PanelChart;

#define PANEL_CHARTS_MAX 48

typedef struct PanelChartList {
    const PlotData *data;
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

/* The ink of the i-th of so many curves that stand in an order; of a pattern's. */
Ink panel_chart_series_ink(const Theme *theme, int i, int count);
Ink panel_chart_pattern_ink(const Theme *theme, Pattern pattern);
Dash panel_chart_pattern_dash(Pattern pattern); /* they differ without colour too */

/* What the chart shows, in inks of the theme. */
ChartRows *panel_chart_rows(const PanelChart *chart, const Theme *theme, Arena *arena);

/* Title, subtitle and the chart itself. */
void panel_chart_draw(Canvas *canvas, Box box, const PanelChart *chart);

/* ---- for those that fill ----------------------------------------------------------------- */

/* A polar map of a field that is copied. */
void panel_chart_polar(ChartRows *out, Field field, PolarMap map);

/* An axis of angles from -90 to 90 degrees; beyond the cone (radians) nothing was measured. */
void panel_chart_angles(ChartRows *out, const char *title, double cone);

/* The same along a section of the hemisphere, through azimuth 0 or (vertical) 90 degrees; and the
 * luminance of codes along it, from -88 to 88 degrees every half. */
#define SECTION_POINTS 353
#define SECTION_AT(deg) (2 * (deg) + 176) /* the point */
void panel_chart_section_axis(ChartRows *out, const PlotData *data, bool is_vertical);
ChartPoints panel_chart_section(const ChartRows *out, const PlotData *data, const float rgb[3],
                                bool is_vertical);
