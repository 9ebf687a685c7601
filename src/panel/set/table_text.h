/* table_text.h -- text that is put together in memory and becomes a file at once.
 *
 * Memory   the arena's; the capacity is fixed, what does not fit is our mistake (assert).
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"

typedef struct TableText {
    char  *begin;
    size_t size, capacity;
} TableText;

TableText table_text(Arena *arena, size_t capacity);

/* printf at the end. */
void table_text_add(TableText *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
