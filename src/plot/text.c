#include "plot/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void text_add_bytes(Text *text, const void *bytes, size_t size)
{
    if (text->size + size + 1 > text->capacity) {
        size_t capacity = 2 * (text->size + size) + 4096;
        char  *bigger = ARENA_NEW(text->arena, char, capacity);
        if (text->size > 0) memcpy(bigger, text->data, text->size);
        text->data = bigger;
        text->capacity = capacity;
    }
    memcpy(text->data + text->size, bytes, size);
    text->size += size;
    text->data[text->size] = 0;
}

void text_add(Text *text, const char *string)
{
    text_add_bytes(text, string, strlen(string));
}

void text_format(Text *text, const char *format, ...)
{
    char    part[1024];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(part, sizeof part, format, arguments);
    va_end(arguments);
    if (length < 0) return;
    if ((size_t)length < sizeof part) {
        text_add_bytes(text, part, (size_t)length);
        return;
    }
    char *whole = ARENA_NEW(text->arena, char, (size_t)length + 1);
    va_start(arguments, format);
    vsnprintf(whole, (size_t)length + 1, format, arguments);
    va_end(arguments);
    text_add_bytes(text, whole, (size_t)length);
}

void text_add_escaped(Text *text, const char *string)
{
    for (const char *c = string ? string : ""; *c; c++) {
        switch (*c) {
        case '&': text_add(text, "&amp;"); break;
        case '<': text_add(text, "&lt;"); break;
        case '>': text_add(text, "&gt;"); break;
        case '"': text_add(text, "&quot;"); break;
        case '\'': text_add(text, "&#39;"); break;
        default: text_add_bytes(text, c, 1);
        }
    }
}
