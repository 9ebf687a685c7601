/* SPDX-License-Identifier: Apache-2.0 */
/* report_azimuth.h -- the azimuths that a report's tables have as columns.
 *
 * Eight, from the viewer's right counter-clockwise. What lies between azimuths that were
 * measured more than 45 degrees apart, and more than 22.5 from each, is not stated.
 *
 * Memory   the report's arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

#define REPORT_AZIMUTHS 8
#define NOT_MEASURED "not measured"

/* Which of them were measured, by the panel file. */
bool report_has_azimuth(const PlotData *data, int index);

/* A column for each of them. */
void report_azimuth_columns(Report *report, ReportTable *table);
