/* SPDX-License-Identifier: Apache-2.0 */
/* text_scan.h -- a text file's numbers as rows of named columns, and its metadata.
 *
 * Lists and matrices (one or more labelled blocks over one grid) both become one table of rows.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/text/text_metadata.h"
#include "import/text/text_options.h"
#include "import/text/text_rows.h"

/* `out` and `metadata` are filled; there is at least one row. */
bool text_scan(const char *file, const TextOptions *options, Arena *arena, NamedRows *out,
               TextMetadata *metadata, Error *err);
