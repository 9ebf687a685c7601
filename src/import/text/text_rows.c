/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_rows.h"

#include <string.h>

#define FIRST_CAPACITY 256

double *text_rows_add(TextRows *rows, int line, Arena *arena)
{
    size_t width = (size_t)rows->width, count = (size_t)rows->count;
    if (rows->count == rows->capacity) {
        rows->capacity = rows->capacity ? 2 * rows->capacity : FIRST_CAPACITY;
        double *cell = ARENA_NEW(arena, double, (size_t)rows->capacity * width);
        int    *lines = ARENA_NEW(arena, int, rows->capacity);
        if (count) memcpy(cell, rows->cell, sizeof *cell * width * count);
        if (count) memcpy(lines, rows->line, sizeof *lines * count);
        rows->cell = cell;
        rows->line = lines;
    }
    rows->line[rows->count++] = line;
    return rows->cell + width * count;
}
