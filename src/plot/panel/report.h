/* SPDX-License-Identifier: Apache-2.0 */
/* report.h -- a panel as one HTML page: every chart, and every number of its report.
 *
 * Memory   the arena's, and address space of its own for the text until it is written.
 * Threads  one call at a time per arena; `threads` of the options sample the panel.
 * Fails    with the file and what cannot be drawn or written.
 */
#pragma once
#include "plot/panel/plot.h"

/* One HTML file with all charts and the panel's numbers as tables; needs nothing else. */
bool plot_write_report(const PlotInput *input, const PlotOptions *options, const char *path,
                       Arena *arena, int *charts, Error *err);
