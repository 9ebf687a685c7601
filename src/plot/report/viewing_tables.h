/* SPDX-License-Identifier: Apache-2.0 */
/* viewing_tables.h -- at which angle a display falls below a limit, its white and its colour
 * at an angle. Units: degrees, cd m^-2, K.
 *
 * Memory   the report's arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

void report_viewing(Report *report, const PlotData *data);
