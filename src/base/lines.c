/* SPDX-License-Identifier: Apache-2.0 */
#include "base/lines.h"

#include <stdarg.h>

void lines_put(Lines *lines, const char *text) {
    if (lines->count == lines->capacity) {
        lines->capacity = 2 * lines->capacity + 8;
        lines->list =
            ARENA_GROW(lines->arena, const char *, lines->list, lines->count, lines->capacity);
    }
    lines->list[lines->count++] = text;
}

void lines_add(Lines *lines, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    char *text = arena_format_list(lines->arena, 2047, format, arguments);
    va_end(arguments);
    lines_put(lines, arena_printable(lines->arena, text));
}
