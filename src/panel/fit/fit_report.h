/* SPDX-License-Identifier: Apache-2.0 */
/* fit_report.h -- how well a fitted panel reproduces what was measured.
 *
 * A ratio of sizes means nothing without the error that it cost: every table states both, and
 * so does the total. Errors are relative, at every measured sample.
 */
#pragma once
#include <jansson.h>

#include "panel/fit/fit_file.h"
#include "panel/fit/fit_table.h"
#include "panel/query/panel.h"

/* Compares the panel with the tables; a new JSON document. */
json_t *fit_report_measure(const FitParts *parts, const Panel *panel, size_t file_bytes);

/* The tables' rows alone, into a list, and their total. */
FitTable fit_report_errors(const FitParts *parts, const Panel *panel, json_t *tables);
