/* SPDX-License-Identifier: Apache-2.0 */
/* plot_charts.h -- the charts of a panel, and what adds them.
 *
 * Memory   the arena of the data. Threads: one at a time. Fails: never.
 */
#pragma once
#include <assert.h>

#include "plot/draw/chart.h"
#include "plot/panel/plot_data.h"

/* In the order of the page. */
typedef enum PlotKind {
    PLOT_ALL,
    PLOT_LUMINANCE,
    PLOT_CONTRAST,
    PLOT_COLOUR_SHIFT,
    PLOT_SECTIONS,
    PLOT_CHROMATICITY,
    PLOT_GREY_LEVELS,
    PLOT_BRDF,
    PLOT_REFLECTANCE,
    PLOT_UNIFORMITY,
    PLOT_FIT,
    PLOT_KIND_COUNT
} PlotKind;

/* As one types them. */
#define PLOT_KINDS \
    "all|luminance|contrast|colour-shift|sections|chromaticity|grey-levels|brdf|reflectance|" \
    "uniformity|fit"

#define PLOT_CHARTS_MAX 16

typedef struct PlotCharts {
    int count;
    Chart *chart[PLOT_CHARTS_MAX];
} PlotCharts;

/* ---- what adds them, each in the file of its name ----------------------------------------- */

typedef void PlotAdd(PlotCharts *charts, const PlotData *data, PlotKind kind);

extern PlotAdd *const emission_charts, *const reflection_charts, *const place_charts;

static inline bool plot_wants(PlotKind asked, PlotKind kind) {
    return asked == PLOT_ALL || asked == kind;
}

static inline void plot_add(PlotCharts *charts, Chart *chart) {
    assert(charts->count < PLOT_CHARTS_MAX);
    charts->chart[charts->count++] = chart;
}

/* A table's samples in the plane through an azimuth: rings over the angle from the normal in
 * degrees, below 0 on the other side. */
void plot_samples(Chart *chart, const AngleTable *table, int channel, double phi, Ink ink);
