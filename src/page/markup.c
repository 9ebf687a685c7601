#include "page/markup.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/file_write.h"

#define MOST_BYTES ((size_t)16 << 30)
#define PIECE_BYTES ((size_t)1 << 16)

struct MarkupPiece {
    MarkupPiece *next;
    size_t       size, capacity;
    char        *bytes;
};

void markup_release(Markup *markup)
{
    arena_release(&markup->own);
    *markup = (Markup){0};
}

static void add_piece(Markup *markup, size_t least)
{
    if (!markup->own.begin) markup->own = arena_reserve(MOST_BYTES);
    MarkupPiece *piece = ARENA_NEW(&markup->own, MarkupPiece, 1);
    piece->capacity = least > PIECE_BYTES ? least : PIECE_BYTES;
    piece->bytes = ARENA_NEW(&markup->own, char, piece->capacity);
    if (markup->last) markup->last->next = piece;
    else markup->first = piece;
    markup->last = piece;
}

/* Room for so many bytes, which are taken for written. */
static char *room_for(Markup *markup, size_t size)
{
    MarkupPiece *last = markup->last;
    if (!last || last->capacity - last->size < size) add_piece(markup, size);
    last = markup->last;
    char *room = last->bytes + last->size;
    last->size += size;
    markup->size += size;
    return room;
}

void markup_add_bytes(Markup *markup, const void *bytes, size_t size)
{
    if (size) memcpy(room_for(markup, size), bytes, size);
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
    size_t length = (size_t)vsnprintf(NULL, 0, format, arguments);
    char  *to = room_for(markup, length + 1);
    vsnprintf(to, length + 1, format, again);
    va_end(again);
    va_end(arguments);
    markup->last->size--; /* the terminator is no part of the text */
    markup->size--;
}

void markup_append(Markup *markup, const Markup *other)
{
    for (const MarkupPiece *p = other->first; p; p = p->next)
        markup_add_bytes(markup, p->bytes, p->size);
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
    char *to = room_for(markup, (size + 2) / 3 * 4);
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

const char *markup_text(const Markup *markup, Arena *arena)
{
    char *text = ARENA_NEW(arena, char, markup->size + 1), *to = text;
    for (const MarkupPiece *p = markup->first; p; p = p->next) {
        memcpy(to, p->bytes, p->size);
        to += p->size;
    }
    return text;
}

bool markup_write(const Markup *markup, const char *path, Error *err)
{
    FileWriter writer;
    if (!file_writer_open(path, &writer, err)) return false;
    for (const MarkupPiece *p = markup->first; p; p = p->next)
        if (!file_writer_add(&writer, p->bytes, p->size, err)) return false;
    return file_writer_commit(&writer, err);
}
