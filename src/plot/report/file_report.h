/* SPDX-License-Identifier: Apache-2.0 */
/* file_report.h -- what a panel file says of itself: sizes and errors of every table, choices,
 * provenance, reasons and notes of its fit.
 *
 * Threads  one at a time per text. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "text/text.h"

void report_of_file(Text *html, const json_t *report, Arena scratch);
