/* SPDX-License-Identifier: Apache-2.0 */
/* pack.h -- structs as bytes, and back: each member that is kept is a row of a table.
 *
 * Bytes    the rows in their order, without gaps, little endian: numbers as they lie; an int,
 *          and a count, of 4 bytes; a flag, and whether a pointer is there, of 1; a text with
 *          the count of its bytes, plus 1, before it (0: NULL); a list with its count.
 *          Members without a row are 0 when they are read.
 * Memory   texts and lists that are read lie in the arena.
 * Threads  pure functions.
 * Fails    reading: bytes may come from anywhere. What is no such table's, or out of a row's
 *          range, is refused; no more memory is taken than its bytes can be of.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#include "text/text.h"

typedef enum PackKind {
    PACK_NUMBERS, /* `size` bytes of doubles, longs: any */
    PACK_FLOATS,  /* `size` bytes of floats, each finite */
    PACK_INT,     /* low to high: a choice, an index */
    PACK_FLAG,    /* bool */
    PACK_TEXT,    /* const char * */
    PACK_TEXTS,   /* const char *const *; int at `count` */
    PACK_PART,    /* a struct `of`, in place */
    PACK_ONE,     /* const struct *, or NULL */
    PACK_LIST     /* const struct *; int at `count`: so many, or, of a list beside another whose
                     row stands before it, so many times `low` */
} PackKind;

typedef struct PackFormat PackFormat;

typedef struct PackRow {
    PackKind kind;
    size_t offset, size, count;
    int low, high;
    const PackFormat *of;
} PackRow;

struct PackFormat {
    size_t size; /* of the struct */
    const PackRow *rows;
    int row_count;
    bool (*is_sound)(const void *item); /* once it is read; NULL: rows say all */
};

/* Adds an item's bytes. */
void pack_add(Text *to, const PackFormat *format, const void *item);

typedef struct PackBytes {
    const unsigned char *at, *end;
} PackBytes;

/* False: they are none of it, and *item means nothing. */
bool pack_take(PackBytes *from, const PackFormat *format, void *item, Arena *arena);
