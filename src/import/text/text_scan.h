/* SPDX-License-Identifier: Apache-2.0 */
/* text_scan.h -- a text file's numbers as rows of named columns, and its metadata.
 *
 * Lists and matrices (one or more labelled blocks over one grid) both become one table of rows.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/text/text_names.h"
#include "import/text/text_options.h"
#include "import/text/text_rows.h"

/* A line index is -1 where the file states nothing. */
typedef struct TextMetadata {
    AzimuthWords azimuth;
    int zero_line, sense_line, side_line;
    ValueUnit unit;
    int unit_line;
    AngleUnit angle;
    int angle_line;
    int unused_columns;
} TextMetadata;

/* `out` and `metadata` are filled; there is at least one row. */
bool text_scan(const char *file, const TextOptions *options, Arena *arena, NamedRows *out,
               TextMetadata *metadata, Error *err);
