/* SPDX-License-Identifier: Apache-2.0 */
/* panel_report.h -- what a fit found, as a panel file keeps it: JSON without default values,
 * and its tables in a few bytes a number.
 *
 * Stored     uint16 rows, uint8 columns | per column: uint8 kind, uint8 length, its key | per
 *            row: uint8 length, its name | numbers row by row: kind 'i' uint32, 'f' float32,
 *            'h' the upper half of a float32, rounded away from 0 (so that a stated error is
 *            never too small). A number that is absent is NaN, an absent integer UINT32_MAX.
 *            "ratio" and "ratio_text" follow from the bytes and are not stored.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "base/error.h"
#include "panel/query/panel.h"

/* tables: objects of a "name" and numbers. Returns the size of *bytes in the arena; 0: memory
 * is out. is_compressed: as the report's text is; its first two bytes are no count of rows. */
size_t panel_report_pack_tables(const json_t *tables, bool is_compressed, Arena *arena,
                                const void **bytes);

/* A new array of such objects; NULL: the bytes are damaged. */
json_t *panel_report_open_tables(const void *bytes, size_t size);

/* What a file keeps of a report without its tables, which it changes: JSON text, compressed as
 * zlib does with panel_words.txt as its dictionary (other words need more bytes; a changed
 * dictionary makes written files unreadable). Returns the size of *bytes in the arena; 0:
 * memory is out. */
size_t panel_report_pack(json_t *report, Arena *arena, const void **bytes);

/* The report inside a panel file; the caller's to release. */
bool panel_report(const Panel *panel, json_t **report, Error *err);
