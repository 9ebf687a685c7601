/* SPDX-License-Identifier: Apache-2.0 */
/* panel_report.h -- what a fit found, as a panel file keeps it: JSON in UTF-8, a zlib stream
 * (RFC 1950). Numbers have 5 digits. What follows from the size of the file is not stored: of
 * "total" the "bytes", of every table "ratio" and "ratio_text".
 *
 * Memory   the caller's to release (json_decref), or the arena's. Threads: pure functions.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "base/error.h"
#include "panel/query/panel.h"

/* Returns the size of *bytes in the arena; 0: memory is out. */
size_t panel_report_pack(const json_t *report, Arena *arena, const void **bytes);

/* The report inside a panel file. Fails (ERROR_INPUT) where it is damaged. */
bool panel_report(const Panel *panel, json_t **report, Error *err);

/* Puts a file's size, without its spots and map, into a report's "total", and into every table
 * the source's bytes over the panel's. */
void panel_report_add_sizes(json_t *report, size_t file_bytes);
