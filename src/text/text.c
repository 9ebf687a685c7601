/* SPDX-License-Identifier: Apache-2.0 */
#include "text/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/file_write.h"

/* Room for `size` more bytes and the zero behind them. */
static void make_room(Text *text, size_t size)
{
    size_t wanted = 2 * (text->size + size) + 4096;
    if (text->size + size < text->capacity) return;
    text->data = arena_grow(text->arena, text->data, text->capacity, wanted, 1);
    text->capacity = wanted;
}

char *text_extend(Text *text, size_t size)
{
    make_room(text, size);
    char *room = text->data + text->size;
    text->size += size;
    text->data[text->size] = 0;
    return room;
}

void text_add_bytes(Text *text, const void *bytes, size_t size)
{
    if (size) memcpy(text_extend(text, size), bytes, size);
}

void text_add(Text *text, const char *string)
{
    text_add_bytes(text, string, strlen(string));
}

void text_format(Text *text, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    make_room(text, 1);
    size_t left = text->capacity - text->size;
    int    length = vsnprintf(text->data + text->size, left, format, arguments);
    if (length > 0 && (size_t)length >= left) {
        make_room(text, (size_t)length);
        vsnprintf(text->data + text->size, (size_t)length + 1, format, again);
    }
    if (length > 0) text->size += (size_t)length;
    va_end(again);
    va_end(arguments);
}

bool text_write(const Text *text, const char *path, Error *err)
{
    return file_write(path, text->data ? text->data : "", text->size, err);
}
