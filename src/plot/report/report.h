/* SPDX-License-Identifier: Apache-2.0 */
/* report.h -- a panel as a laboratory's report: one HTML page that prints on A4, and the same
 * tables as CSV and JSON.
 *
 * Memory   the arena's, and address space of its own for the page until it is written.
 * Threads  one call at a time per arena.
 * Fails    with the file and what cannot be drawn or written.
 */
#pragma once
#include "plot/panel/plot.h"
#include "plot/report/panel_tables.h"

typedef struct ReportSpec {
    PlotInput input;
    Ambient ambient;
    const TableKind *info_kind; /* of what the page shows first: */
    const json_t *info;         /* what `panel info` has of the panel */
    const char *page;           /* X.html; NULL: none */
    const char *tables;         /* a folder for the CSV files and report.json; NULL: none */
} ReportSpec;

/* Makes all tables and writes what is requested; *answer is the caller's: the document of
 * report.json. */
bool panel_report_write(const ReportSpec *spec, Arena *arena, json_t **answer, Error *err);
