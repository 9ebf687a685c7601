/* SPDX-License-Identifier: Apache-2.0 */
/* level_tables.h -- gamma by angle, and where greys are inverted.
 *
 * Memory   the report's arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

void report_levels(Report *report, const PlotData *data);
