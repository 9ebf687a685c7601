/* SPDX-License-Identifier: Apache-2.0 */
/* state_tables.h -- the report's table of a display's states: white, black, half luminance,
 * verdict and errors of each.
 *
 * Threads  no shared state. Fails: never; a file of one state has no such table.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

void report_states(Report *report, const PlotData *data);
