/* SPDX-License-Identifier: Apache-2.0 */
/* text_rows.h -- rows of numbers with the line of each, and names for their columns.
 *
 * Memory   the arena's. Threads: no shared state.
 */
#pragma once
#include "import/text/text_names.h"

#define TEXT_COLUMNS_MAX 2048

typedef struct TextRows {
    int     width, count, capacity;
    double *cell; /* count x width; NAN: marked as not measured */
    int    *line; /* index of each row's line */
} TextRows;

typedef struct NamedColumn {
    ColumnName  name;
    const char *text; /* as the file or the user writes it */
    int         from; /* cell of a row */
} NamedColumn;

/* The common form of lists and matrices. */
typedef struct NamedRows {
    const char *file;
    NamedColumn column[TEXT_COLUMNS_MAX];
    TextRows    rows; /* its width is the number of columns */
} NamedRows;

/* Room for one more row of `width` cells. */
double *text_rows_add(TextRows *rows, int line, Arena *arena);
