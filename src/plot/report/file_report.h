/* SPDX-License-Identifier: Apache-2.0 */
/* file_report.h -- what a panel file says of itself: sizes and errors of every table, choices,
 * provenance, reasons and notes of its fit.
 *
 * Threads  no shared state. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"

/* Sets "sizes", "lists", "reasons" and "notes" of the page's values. */
void report_of_file(json_t *to, const json_t *report, Arena scratch);
