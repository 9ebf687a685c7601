/* SPDX-License-Identifier: Apache-2.0 */
/* place_tables.h -- luminance over the active area, at nine points and anywhere, cd m^-2.
 *
 * Memory   the report's arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

void report_places(Report *report, const PlotData *data);
