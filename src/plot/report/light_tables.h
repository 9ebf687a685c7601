/* SPDX-License-Identifier: Apache-2.0 */
/* light_tables.h -- reflectance by incidence, in percent, and contrast in ambient light.
 *
 * Memory   the report's arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

void report_reflection(Report *report, const PlotData *data);
void report_ambient(Report *report, const PlotData *data);
