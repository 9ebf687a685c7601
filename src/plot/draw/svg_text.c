/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/svg_text.h"

#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Names seen so far, in a table with open addressing. */
typedef struct Names {
    const char **name;
    size_t      *length;
    int         *number;
    size_t       capacity;
    int          count;
} Names;

static int number_of(Names *names, const char *name, size_t length)
{
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (size_t i = 0; i < length; i++) hash = (hash ^ (unsigned char)name[i]) * 16777619u;
    size_t at = hash & (names->capacity - 1);
    while (names->name[at] && (names->length[at] != length ||
                               memcmp(names->name[at], name, length)))
        at = (at + 1) & (names->capacity - 1);
    if (!names->name[at]) {
        names->name[at] = name;
        names->length[at] = length;
        names->number[at] = names->count++;
    }
    return names->number[at];
}

static bool is_name_letter(char c)
{
    return isalnum((unsigned char)c) || c == '-' || c == '_';
}

/* Behind id=" or inside href="#..." and url(#...)? Then the length of the name, else 0. */
static size_t name_at(const char *begin, const char *p)
{
    size_t length = 0;
    bool   is_id = p - begin >= 5 && !memcmp(p - 5, " id=\"", 5);
    bool   is_use = p - begin >= 2 && p[-1] == '#' && (p[-2] == '"' || p[-2] == '(');
    if (!is_id && !is_use) return 0;
    while (is_name_letter(p[length])) length++;
    return length;
}

static const char *skip_declaration(const char *p)
{
    if (strncmp(p, "<?xml", 5)) return p;
    const char *end = strstr(p, "?>");
    if (!end) return p;
    end += 2;
    while (*end == '\n' || *end == '\r') end++;
    return end;
}

/* A point and its decimals, three of them at most and no zeros at the end; how many letters
 * were read. */
static size_t add_decimals(const char *p, char **to)
{
    size_t read = 1, kept = 0;
    while (isdigit((unsigned char)p[read])) read++;
    for (size_t i = 1; i < read && i <= 3; i++)
        if (p[i] != '0') kept = i;
    if (kept > 0) {
        memcpy(*to, p, kept + 1);
        *to += kept + 1;
    }
    return read;
}

PlotBytes svg_with_ids(PlotBytes svg, const char *prefix, bool is_inline, Arena *arena)
{
    const char *begin = (const char *)svg.data, *end = begin + svg.size;
    size_t      ids = 0;
    for (const char *p = begin; p < end; p++) ids += name_at(begin, p) > 0;
    Names names = {.capacity = 64};
    while (names.capacity < 2 * ids) names.capacity *= 2;
    names.name = ARENA_NEW(arena, const char *, names.capacity);
    names.length = ARENA_NEW(arena, size_t, names.capacity);
    names.number = ARENA_NEW(arena, int, names.capacity);
    size_t room = svg.size + ids * (strlen(prefix) + 12) + 1;
    char  *out = ARENA_NEW(arena, char, room), *to = out;
    bool in_path = false;
    for (const char *p = is_inline ? skip_declaration(begin) : begin; p < end;) {
        size_t length = name_at(begin, p);
        if (*p == '"') in_path = p - begin >= 3 && !memcmp(p - 3, " d=", 3);
        if (in_path && *p == '.') {
            p += add_decimals(p, &to);
            continue;
        }
        if (length == 0) {
            *to++ = *p++;
            continue;
        }
        to += snprintf(to, room - (size_t)(to - out), "%s%d", prefix,
                       number_of(&names, p, length));
        p += length;
    }
    *to = 0;
    return (PlotBytes){(unsigned char *)out, (size_t)(to - out)};
}
