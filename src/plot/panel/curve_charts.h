/* SPDX-License-Identifier: Apache-2.0 */
/* curve_charts.h -- luminance along two sections of the hemisphere, and over the grey levels.
 *
 * Memory   the list's data have the arena. Threads: one list at a time. Fails: never.
 */
#pragma once
#include "plot/panel/panel_chart.h"

/* Adds those that the data allow. */
void curve_charts_add(PanelChartList *list, const PlotData *data);
