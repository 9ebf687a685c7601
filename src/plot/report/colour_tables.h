/* SPDX-License-Identifier: Apache-2.0 */
/* colour_tables.h -- the primaries and the gamut, in percent of the standards'.
 *
 * Memory   the report's arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

void report_colour(Report *report, const PlotData *data);
