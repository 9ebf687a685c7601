/* SPDX-License-Identifier: Apache-2.0 */
/* report_parts.h -- the tables of a panel's report, part by part, each in the file of its name:
 * what a display laboratory states of a panel, asked of the panel itself.
 *
 * Where a datum was not measured the table says so and has no figure. Azimuths are eight, from
 * the viewer's right counter-clockwise; what lies between azimuths that were measured more than
 * 45 degrees apart, and 22.5 from each, is not stated.
 *
 * Units    of the tables: degrees, cd m^-2, K, percent where the key says so.
 * Memory   the report's arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "plot/panel/plot_data.h"
#include "plot/report/report_table.h"

#define REPORT_AZIMUTHS 8
#define NOT_MEASURED "not measured"

/* Which of the eight azimuths were measured, by the panel file. */
bool report_has_azimuth(const PlotData *data, int index);

/* A column for each of the eight azimuths. */
void report_azimuth_columns(Report *report, ReportTable *table);

void report_viewing(Report *report, const PlotData *data);    /* viewing_tables.c */
void report_colour(Report *report, const PlotData *data);     /* colour_tables.c */
void report_levels(Report *report, const PlotData *data);     /* level_tables.c */
void report_reflection(Report *report, const PlotData *data); /* light_tables.c */
void report_ambient(Report *report, const PlotData *data);    /* light_tables.c */
void report_errors(Report *report, const PlotData *data);     /* file_report.c */
