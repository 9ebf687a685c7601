/* SPDX-License-Identifier: Apache-2.0 */
/* place_charts.h -- charts of a panel that is not the same everywhere: white and black over the
 * active area with the nine points, and the viewing angle by place. */
#pragma once
#include "plot/panel/panel_chart.h"

void place_charts_add(PanelChartList *list, const PlotData *data);
