/* SPDX-License-Identifier: Apache-2.0 */
/* file_report.h -- what a panel file says of itself: sizes and errors of every table.
 *
 * Memory   the arena's. Threads: no shared state. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "table/table.h"

/* A row for each table that was fitted, and their total; NULL: the file has none. */
Table *panel_file_table(const json_t *report, Arena *arena);
