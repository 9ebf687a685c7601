/* SPDX-License-Identifier: Apache-2.0 */
#include "keep/pack.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static const char *member(const void *item, size_t offset) {
    return (const char *)item + offset;
}

static int int_at(const void *item, size_t offset) {
    int value;
    memcpy(&value, member(item, offset), sizeof value);
    return value;
}

static const void *pointer_at(const void *item, size_t offset) {
    const void *pointer;
    memcpy(&pointer, member(item, offset), sizeof pointer);
    return pointer;
}

/* ---- writing ----------------------------------------------------------------------------- */

static void add_int(Text *to, int value) {
    text_add_bytes(to, (const char *)&value, sizeof value);
}

static void add_text(Text *to, const char *text) {
    add_int(to, text ? (int)strlen(text) + 1 : 0);
    if (text) text_add(to, text);
}

static void add_flag(Text *to, bool flag) {
    text_add_bytes(to, flag ? "\1" : "\0", 1);
}

static void add_texts(Text *to, const char *const *list, int count) {
    add_int(to, count);
    for (int i = 0; i < count; i++) add_text(to, list[i]);
}

static void add_list(Text *to, const PackFormat *of, const void *list, int count) {
    add_int(to, count);
    for (int i = 0; i < count; i++) pack_add(to, of, member(list, (size_t)i * of->size));
}

static void add_row(Text *to, const PackRow *row, const void *item) {
    const void *at = member(item, row->offset);
    const void *pointer;
    switch (row->kind) {
    case PACK_NUMBERS:
    case PACK_FLOATS: text_add_bytes(to, at, row->size); break;
    case PACK_INT: add_int(to, int_at(item, row->offset)); break;
    case PACK_FLAG: add_flag(to, *(const bool *)at); break;
    case PACK_TEXT: add_text(to, pointer_at(item, row->offset)); break;
    case PACK_TEXTS: add_texts(to, pointer_at(item, row->offset), int_at(item, row->count)); break;
    case PACK_PART: pack_add(to, row->of, at); break;
    case PACK_ONE:
        pointer = pointer_at(item, row->offset);
        add_flag(to, pointer != NULL);
        if (pointer) pack_add(to, row->of, pointer);
        break;
    case PACK_LIST:
        add_list(to, row->of, pointer_at(item, row->offset),
                 int_at(item, row->count) / (row->low ? row->low : 1));
    }
}

void pack_add(Text *to, const PackFormat *format, const void *item) {
    for (int i = 0; i < format->row_count; i++) add_row(to, &format->rows[i], item);
}

/* ---- reading ----------------------------------------------------------------------------- */

static bool take(PackBytes *from, void *to, size_t size) {
    if ((size_t)(from->end - from->at) < size) return false;
    memcpy(to, from->at, size);
    from->at += size;
    return true;
}

static bool take_flag(PackBytes *from, bool *out) {
    unsigned char byte;
    if (!take(from, &byte, 1) || byte > 1) return false;
    *out = byte;
    return true;
}

/* Of items that take a byte at least. */
static bool take_count(PackBytes *from, int *out) {
    return take(from, out, sizeof *out) && *out >= 0 && *out <= from->end - from->at;
}

static bool take_text(PackBytes *from, const char **out, Arena *arena) {
    int size;
    *out = NULL;
    if (!take(from, &size, sizeof size) || size < 0) return false;
    if (size == 0) return true;
    if (size - 1 > from->end - from->at || memchr(from->at, '\0', (size_t)size - 1)) return false;
    *out = arena_string(arena, (const char *)from->at, (size_t)size - 1);
    from->at += size - 1;
    return true;
}

static bool take_texts(PackBytes *from, const char ***out, int *count, Arena *arena) {
    if (!take_count(from, count)) return false;
    *out = ARENA_NEW(arena, const char *, *count);
    for (int i = 0; i < *count; i++)
        if (!take_text(from, &(*out)[i], arena) || !(*out)[i]) return false;
    return true;
}

static bool take_floats(PackBytes *from, void *to, size_t size) {
    if (!take(from, to, size)) return false;
    for (size_t i = 0; i < size; i += sizeof(float)) {
        float value;
        memcpy(&value, (const char *)to + i, sizeof value);
        if (!isfinite(value)) return false;
    }
    return true;
}

/* The fewest bytes of an item. */
static size_t least_bytes(const PackFormat *format) {
    size_t sum = 0;
    for (int i = 0; i < format->row_count; i++) {
        const PackRow *row = &format->rows[i];
        bool is_plain = row->kind == PACK_NUMBERS || row->kind == PACK_FLOATS;
        bool is_byte = row->kind == PACK_FLAG || row->kind == PACK_ONE;
        sum += is_plain                 ? row->size
               : row->kind == PACK_PART ? least_bytes(row->of)
               : is_byte                ? 1
                                        : sizeof(int);
    }
    return sum;
}

static bool take_list(PackBytes *from, const PackFormat *of, void **out, int *count, Arena *arena) {
    if (!take_count(from, count)) return false;
    if ((size_t)*count > (size_t)(from->end - from->at) / least_bytes(of)) return false;
    char *list = arena_alloc(arena, of->size, _Alignof(max_align_t), (size_t)*count);
    for (int i = 0; i < *count; i++)
        if (!pack_take(from, of, list + (size_t)i * of->size, arena)) return false;
    *out = list;
    return true;
}

static bool take_int(PackBytes *from, const PackRow *row, int *out) {
    return take(from, out, sizeof *out) && *out >= row->low && *out <= row->high;
}

static bool take_pointer(PackBytes *from, const PackRow *row, void *item, Arena *arena) {
    void *pointer = NULL;
    int count = 0;
    bool ok = false, is_there = false;
    if (row->kind == PACK_TEXT) ok = take_text(from, (const char **)&pointer, arena);
    if (row->kind == PACK_TEXTS) ok = take_texts(from, (const char ***)&pointer, &count, arena);
    if (row->kind == PACK_LIST) ok = take_list(from, row->of, &pointer, &count, arena);
    if (row->kind == PACK_ONE) {
        ok = take_flag(from, &is_there);
        if (ok && is_there) {
            pointer = arena_alloc(arena, row->of->size, _Alignof(max_align_t), 1);
            ok = pack_take(from, row->of, pointer, arena);
        }
    }
    memcpy((char *)item + row->offset, &pointer, sizeof pointer);
    if (row->kind == PACK_LIST && row->low)
        return ok && count == int_at(item, row->count) / row->low;
    if (row->kind == PACK_TEXTS || row->kind == PACK_LIST)
        memcpy((char *)item + row->count, &count, sizeof count);
    return ok;
}

static bool take_row(PackBytes *from, const PackRow *row, void *item, Arena *arena) {
    char *at = (char *)item + row->offset;
    switch (row->kind) {
    case PACK_NUMBERS: return take(from, at, row->size);
    case PACK_FLOATS: return take_floats(from, at, row->size);
    case PACK_INT: return take_int(from, row, (int *)(void *)at);
    case PACK_FLAG: return take_flag(from, (bool *)at);
    case PACK_PART: return pack_take(from, row->of, at, arena);
    case PACK_TEXT:
    case PACK_TEXTS:
    case PACK_ONE:
    case PACK_LIST: return take_pointer(from, row, item, arena);
    }
    return false;
}

bool pack_take(PackBytes *from, const PackFormat *format, void *item, Arena *arena) {
    memset(item, 0, format->size);
    for (int i = 0; i < format->row_count; i++)
        if (!take_row(from, &format->rows[i], item, arena)) return false;
    return !format->is_sound || format->is_sound(item);
}
