/* SPDX-License-Identifier: Apache-2.0 */
/* plot.h -- pictures of a measured panel, as display engineers draw them.
 *
 * Output   SVG or PNG from the same drawing; the same bytes for the same input and library.
 * Memory   the arena's; the picture appears under its name only when it is whole.
 * Threads  one call at a time per arena.
 * Fails    with the file and what cannot be drawn or written.
 */
#pragma once
#include "plot/draw/picture.h"
#include "plot/panel/plot_charts.h"

/* Those of a kind, or all, that the panel's data allow. */
PlotCharts plot_charts(const PlotData *data, PlotKind kind);

/* By the ending of path: .svg or .png. *charts: how many it shows. */
bool plot_write(const PlotInput *input, PlotKind kind, const char *path, Arena *arena, int *charts,
                Error *err);

/* A chart alone, without its title, as SVG. */
bool plot_chart_svg(const Chart *chart, double width, double height, Arena *arena, PlotBytes *out,
                    Error *err);
