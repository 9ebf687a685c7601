/* SPDX-License-Identifier: Apache-2.0 */
/* tiff_directory.h -- numbers in the directories of a TIFF, one a page, or of what Exif states,
 * which is one (TIFF 6.0, section 2).
 *
 * Memory   a view of the bytes. Threads: pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A TIFF or, with wider numbers, a BigTIFF. */
typedef struct Tiff {
    const unsigned char *bytes;
    size_t size;
    bool is_big_endian, is_wide;
} Tiff;

/* bytes: at least 4. */
static inline Tiff tiff_open(const unsigned char *bytes, size_t size) {
    return (Tiff){bytes, size, bytes[0] == 'M', bytes[2] == '+' || bytes[3] == '+'};
}

/* 0 where the file does not hold all of its bytes. */
static inline uint64_t tiff_number(const Tiff *tiff, uint64_t at, unsigned width) {
    uint64_t value = 0;
    if (at > tiff->size || tiff->size - at < width) return 0;
    for (unsigned i = 0; i < width; i++)
        value = value << 8 | tiff->bytes[at + (tiff->is_big_endian ? i : width - 1 - i)];
    return value;
}

/* The numbers of one entry of a directory; count 0: it has none. */
typedef struct TiffList {
    uint64_t at, count;
    unsigned width; /* bytes of one */
} TiffList;

static inline unsigned tiff_wide(const Tiff *tiff) {
    return tiff->is_wide ? 8 : 4;
}

static inline uint64_t tiff_first(const Tiff *tiff) {
    return tiff_number(tiff, tiff_wide(tiff), tiff_wide(tiff));
}

/* The directory behind that which stands at `at`; 0: it is the last. */
static inline uint64_t tiff_next(const Tiff *tiff, uint64_t at) {
    unsigned wide = tiff_wide(tiff), head = tiff->is_wide ? 8 : 2;
    uint64_t entries = tiff_number(tiff, at, head);
    return entries < tiff->size ? tiff_number(tiff, at + head + entries * (4 + 2 * wide), wide) : 0;
}

static inline TiffList tiff_list_in(const Tiff *tiff, uint64_t at, unsigned tag) {
    unsigned wide = tiff_wide(tiff), head = tiff->is_wide ? 8 : 2;
    uint64_t entries = tiff_number(tiff, at, head);
    at += head;
    for (uint64_t i = 0; i < entries && at < tiff->size; i++, at += 4 + 2 * wide) {
        if (tiff_number(tiff, at, 2) != tag) continue;
        uint64_t type = tiff_number(tiff, at + 2, 2), value = at + 4 + wide;
        TiffList out = {value, tiff_number(tiff, at + 4, wide),
                        type == 3                ? 2
                        : type == 16             ? 8
                        : type == 1 || type == 7 ? 1
                                                 : 4};
        if (out.count * out.width > wide) out.at = tiff_number(tiff, value, wide);
        return out;
    }
    return (TiffList){0, 0, 0};
}

/* Of the first directory. */
static inline TiffList tiff_list(const Tiff *tiff, unsigned tag) {
    return tiff_list_in(tiff, tiff_first(tiff), tag);
}
