/* SPDX-License-Identifier: Apache-2.0 */
/* csv_table.h -- a table of finite numbers from a text file, with the line of every row.
 *
 * A header line of column names, then one row a line; commas (or semicolons or tabs, as in the
 * header line) between cells, # comments and empty lines allowed. Every cell must be a finite
 * number, every name another one.
 *
 * Memory   the arena's.
 * Fails    with the file, the line, the column's name, what was found and what was required.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"

#define CSV_COLUMNS_MAX 2048

typedef struct CsvTable {
    const char *file;
    const char **name; /* per column, blanks around it removed */
    int columns, rows;
    const float *cell; /* rows x columns */
    const int *line;   /* of every row, from 1 */
    size_t bytes;      /* size of the file */
} CsvTable;

bool csv_table_read(const char *file, Arena *arena, CsvTable *out, Error *err);

/* The column of that name (exact), or -1. */
int csv_table_column(const CsvTable *table, const char *name);

/* Refuses a column that is not among the known ones. */
bool csv_table_check_columns(const CsvTable *table, const char *const *known, int count,
                             Error *err);

/* "line 12" in the arena: the place of a row for error_at. */
const char *csv_table_place(const CsvTable *table, int row, Arena *arena);
