/* SPDX-License-Identifier: Apache-2.0 */
/* error_tables.h -- how far the panel file is from what was measured, in percent.
 *
 * Memory   the report's arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

void report_errors(Report *report, const PlotData *data);
