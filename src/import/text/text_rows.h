/* SPDX-License-Identifier: Apache-2.0 */
/* text_rows.h -- rows of numbers with the line of each, and names for their columns.
 *
 * Memory   the arena's. Threads: no shared state.
 */
#pragma once
#include "import/text/text_options.h"

typedef struct TextRows {
    int width, count, capacity;
    double *cell; /* count x width; NAN: marked as not measured */
    int *line;    /* index of each row's line */
} TextRows;

typedef struct NamedColumn {
    ColumnName name;
    const char *text; /* as the file or the user writes it */
    int from;         /* cell of a row */
} NamedColumn;

/* The common form of lists and matrices. */
typedef struct NamedRows {
    NamedColumn column[TEXT_COLUMNS_MAX];
    TextRows rows; /* its width is the number of columns */
} NamedRows;

/* Room for one more row of `width` cells. */
static inline double *text_rows_add(TextRows *rows, int line, Arena *arena) {
    size_t width = (size_t)rows->width, count = (size_t)rows->count;
    if (rows->count == rows->capacity) {
        rows->capacity = rows->capacity ? 2 * rows->capacity : 256;
        rows->cell =
            ARENA_GROW(arena, double, rows->cell, width *count, width *(size_t)rows->capacity);
        rows->line = ARENA_GROW(arena, int, rows->line, count, rows->capacity);
    }
    rows->line[rows->count++] = line;
    return rows->cell + width * count;
}
