#include "panel/set/table_text.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>

TableText table_text(Arena *arena, size_t capacity)
{
    return (TableText){ARENA_NEW(arena, char, capacity), 0, capacity};
}

void table_text_add(TableText *text, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    int added = vsnprintf(text->begin + text->size, text->capacity - text->size, format, args);
    va_end(args);
    assert(added >= 0 && (size_t)added < text->capacity - text->size);
    text->size += (size_t)added;
}
