/* SPDX-License-Identifier: Apache-2.0 */
/* colour_charts.h -- the chromaticity diagram, white over angle, the primaries' spectra.
 *
 * Memory   the list's data have the arena. Threads: one list at a time. Fails: never.
 */
#pragma once
#include "plot/panel/panel_chart.h"

/* Adds those that the data allow. */
void colour_charts_add(PanelChartList *list, const PlotData *data);
