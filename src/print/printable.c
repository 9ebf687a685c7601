/* SPDX-License-Identifier: Apache-2.0 */
#include "print/printable.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "print/utf8.h"

/* First and last of each range. */
static bool is_escaped(unsigned code) {
    static const unsigned short ranges[][2] = {
        {0x0, 0x1f},      {0x7f, 0x9f},     {0xad, 0xad},     {0x61c, 0x61c},   {0x180e, 0x180e},
        {0x200b, 0x200b}, {0x200e, 0x200f}, {0x2028, 0x202e}, {0x2060, 0x2064}, {0x2066, 0x206f},
        {0xfeff, 0xfeff}, {0xfff9, 0xfffb}, {0xfffe, 0xffff}};
    for (int i = 0; i < (int)(sizeof ranges / sizeof *ranges); i++)
        if (code >= ranges[i][0] && code <= ranges[i][1]) return true;
    return false;
}

size_t printable_next(const char *at, size_t left, char to[PRINTABLE_ROOM]) {
    unsigned code = 0;
    int length = utf8_decode(at, left, &code);
    if (!length) snprintf(to, PRINTABLE_ROOM, "\\x%02X", (unsigned)(unsigned char)*at);
    else if (is_escaped(code)) snprintf(to, PRINTABLE_ROOM, "\\u%04X", code & 0xffff);
    else {
        memcpy(to, at, (size_t)length);
        to[length] = '\0';
    }
    return length ? (size_t)length : 1;
}

size_t printable_size(const char *text) {
    char one[PRINTABLE_ROOM];
    size_t size = 1;
    for (; *text; size += strlen(one)) text += printable_next(text, UTF8_BYTES_MAX, one);
    return size;
}

void printable_copy(char *to, size_t size, const char *from) {
    char one[PRINTABLE_ROOM];
    size_t used = 0;
    while (*from) {
        from += printable_next(from, UTF8_BYTES_MAX, one);
        if (used + strlen(one) >= size) break;
        memcpy(to + used, one, strlen(one));
        used += strlen(one);
    }
    to[used] = '\0';
}
