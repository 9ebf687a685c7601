#include "compare/markup.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define MOST_BYTES ((size_t)16 << 30)

Markup markup_start(void)
{
    return (Markup){arena_reserve(MOST_BYTES)};
}

void markup_release(Markup *markup)
{
    arena_release(&markup->own);
}

void markup_add_bytes(Markup *markup, const void *bytes, size_t size)
{
    char *to = ARENA_NEW(&markup->own, char, size);
    if (size) memcpy(to, bytes, size);
}

void markup_add(Markup *markup, const char *text)
{
    markup_add_bytes(markup, text, strlen(text));
}

void markup_format(Markup *markup, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int   length = vsnprintf(NULL, 0, format, arguments);
    char *to = ARENA_NEW(&markup->own, char, length + 1);
    vsnprintf(to, (size_t)length + 1, format, again);
    va_end(again);
    va_end(arguments);
    markup->own.next--; /* the terminator is no part of the text */
}

/* Length of the UTF-8 letter at p (RFC 3629) that XML 1.0 allows, 0 when there is none. */
static size_t letter_length(const unsigned char *p)
{
    static const unsigned LEAST[] = {0, 0, 0x80, 0x800, 0x10000};
    size_t   length = p[0] < 0x80 ? 1 : p[0] >= 0xf0 ? 4 : p[0] >= 0xe0 ? 3 : 2;
    unsigned code = length == 1 ? p[0] : p[0] & (0xffu >> (length + 1));
    if (p[0] == '\t' || p[0] == '\n' || p[0] == '\r') return 1;
    if (p[0] < 0x20 || p[0] == 0x7f || (p[0] >= 0x80 && p[0] < 0xc2) || p[0] > 0xf4) return 0;
    for (size_t i = 1; i < length; i++) {
        if ((p[i] & 0xc0) != 0x80) return 0;
        code = code << 6 | (p[i] & 0x3fu);
    }
    bool forbidden = (code >= 0xd800 && code < 0xe000) || code == 0xfffe || code == 0xffff;
    return code >= LEAST[length] && code < 0x110000 && !forbidden ? length : 0;
}

void markup_escape(Markup *markup, const char *text)
{
    for (const char *c = text ? text : ""; *c;) {
        size_t length = letter_length((const unsigned char *)c);
        switch (*c) {
        case '&': markup_add(markup, "&amp;"); break;
        case '<': markup_add(markup, "&lt;"); break;
        case '>': markup_add(markup, "&gt;"); break;
        case '"': markup_add(markup, "&quot;"); break;
        case '\'': markup_add(markup, "&#39;"); break;
        default: markup_add_bytes(markup, length ? c : "?", length ? length : 1);
        }
        c += length ? length : 1;
    }
}

void markup_base64(Markup *markup, const void *bytes, size_t size)
{
    static const char DIGITS[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *from = bytes;
    char *to = ARENA_NEW(&markup->own, char, (size + 2) / 3 * 4);
    for (size_t i = 0; i < size; i += 3) {
        size_t   left = size - i;
        unsigned three = (unsigned)from[i] << 16 | (left > 1 ? (unsigned)from[i + 1] << 8 : 0) |
                         (left > 2 ? from[i + 2] : 0);
        *to++ = DIGITS[three >> 18];
        *to++ = DIGITS[three >> 12 & 63];
        *to++ = left > 1 ? DIGITS[three >> 6 & 63] : '=';
        *to++ = left > 2 ? DIGITS[three & 63] : '=';
    }
}
