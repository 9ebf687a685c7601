#include "compare/lines.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void lines_put(Lines *lines, const char *text)
{
    if (lines->count == lines->capacity) {
        int          capacity = 2 * lines->capacity + 8;
        const char **list = ARENA_NEW(lines->arena, const char *, capacity);
        if (lines->count) memcpy(list, lines->list, sizeof *list * (size_t)lines->count);
        lines->list = list;
        lines->capacity = capacity;
    }
    lines->list[lines->count++] = text;
}

void lines_add(Lines *lines, const char *format, ...)
{
    char    text[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (char *c = text; *c; c++) /* what files say must not steer a terminal */
        if ((unsigned char)*c < 0x20 || *c == 0x7f) *c = ' ';
    lines_put(lines, arena_string(lines->arena, text, strlen(text)));
}
