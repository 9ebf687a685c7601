/* SPDX-License-Identifier: Apache-2.0 */
/* report.h -- a panel as a laboratory's report: one HTML page that prints on A4, and the same
 * tables as CSV and JSON.
 *
 * Memory   the arena's, and address space of its own for the page until it is written.
 * Threads  one call at a time per arena; `threads` of the options sample the panel.
 * Fails    with the file and what cannot be drawn or written.
 */
#pragma once
#include "plot/panel/plot.h"

/* Files to write; NULL: not that one. */
typedef struct ReportOutput {
    const char *page;   /* X.html */
    const char *tables; /* a folder for the CSV files and report.json */
} ReportOutput;

/* Makes all tables and writes what is requested; *answer is the caller's: the document of
 * report.json. */
bool panel_report_write(const PlotInput *input, const PlotOptions *options,
                        const ReportOutput *output, Arena *arena, json_t **answer, Error *err);
