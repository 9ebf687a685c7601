/* SPDX-License-Identifier: Apache-2.0 */
/* fit_charts.h -- measured against fitted: points over the curves, and what is left.
 *
 * Memory   the list's data have the arena. Threads: one list at a time. Fails: never.
 */
#pragma once
#include "plot/panel/panel_chart.h"

/* Adds those that the data allow. */
void fit_charts_add(PanelChartList *list, const PlotData *data);
