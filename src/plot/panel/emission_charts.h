/* SPDX-License-Identifier: Apache-2.0 */
/* emission_charts.h -- polar maps of what the panel emits: luminance, contrast, colour shift.
 *
 * Memory   the list's data have the arena. Threads: one list at a time. Fails: never.
 */
#pragma once
#include "plot/panel/panel_chart.h"

/* Adds those that the data allow. */
void emission_charts_add(PanelChartList *list, const PlotData *data);
