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

/* Compares the panel with the tables; a new JSON document, still without the file's size
 * (panel_report_add_sizes). */
json_t *fit_report_measure(const FitParts *parts, const Panel *panel);
