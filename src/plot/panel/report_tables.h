/* SPDX-License-Identifier: Apache-2.0 */
/* report_tables.h -- a panel's own report (JSON) as tables of an HTML page.
 *
 * All that the report holds is shown: known words get readable names and units, unknown ones
 * stand as they are.
 *
 * Memory   the text's. Threads: one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "text/text.h"

/* The table of tables with its totals. */
void report_add_tables(Text *html, const json_t *report, Arena scratch);

/* Everything else but the notes: choices, sizes, provenance. */
void report_add_choices(Text *html, const json_t *report, Arena scratch);

/* The notes as a list; nothing when there are none. */
void report_add_notes(Text *html, const json_t *report, Arena scratch);
