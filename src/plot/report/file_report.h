/* SPDX-License-Identifier: Apache-2.0 */
/* file_report.h -- what a panel file says of itself: sizes and errors of every table, choices,
 * provenance, reasons and notes of its fit.
 *
 * Memory   the arena's. Threads: no shared state. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "table/table.h"

/* Sets "sizes", "lists", "reasons" and "notes" of the page's values. */
void report_of_file(json_t *to, const json_t *report, Arena *arena);

/* A row for each table that was fitted, and their total; NULL: the file has none. */
Table *panel_file_table(const json_t *report, Arena *arena);
