/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_charts.h -- the BRDF in sections, over wavelength and the hemisphere; the mirror.
 *
 * Memory   the list's data have the arena. Threads: one list at a time. Fails: never.
 */
#pragma once
#include "plot/panel/panel_chart.h"

/* Adds those that the data allow. */
void reflection_charts_add(PanelChartList *list, const PlotData *data);
