#include "text/text.h"

#include <stdarg.h>
#include <stdbool.h>
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

/* Length of the UTF-8 letter at p (RFC 3629), 0 when there is none. */
static size_t letter_length(const unsigned char *p)
{
    static const unsigned LEAST[] = {0, 0, 0x80, 0x800, 0x10000};
    size_t   length = p[0] < 0x80 ? 1 : p[0] >= 0xf0 ? 4 : p[0] >= 0xe0 ? 3 : 2;
    unsigned code = length == 1 ? p[0] : p[0] & (0xffu >> (length + 1));
    if (p[0] < 0x20 || p[0] == 0x7f || (p[0] >= 0x80 && p[0] < 0xc2) || p[0] > 0xf4) return 0;
    for (size_t i = 1; i < length; i++) {
        if ((p[i] & 0xc0) != 0x80) return 0;
        code = code << 6 | (p[i] & 0x3fu);
    }
    bool is_surrogate = code >= 0xd800 && code < 0xe000;
    return code >= LEAST[length] && code < 0x110000 && !is_surrogate ? length : 0;
}

const char *text_clean(const char *string, Arena *arena)
{
    char *copy = arena_string(arena, string, strlen(string));
    for (unsigned char *p = (unsigned char *)copy; *p;) {
        size_t length = letter_length(p);
        if (length == 0) *p = '?';
        p += length > 0 ? length : 1;
    }
    return copy;
}
