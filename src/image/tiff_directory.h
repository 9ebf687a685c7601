/* SPDX-License-Identifier: Apache-2.0 */
/* tiff_directory.h -- numbers in the first directory of a TIFF, or of what Exif tells, which is
 * one (TIFF 6.0, section 2).
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
    bool   is_big_endian, is_wide;
} Tiff;

/* bytes: at least 4. */
static inline Tiff tiff_open(const unsigned char *bytes, size_t size)
{
    return (Tiff){bytes, size, bytes[0] == 'M', bytes[2] == '+' || bytes[3] == '+'};
}

/* 0 where the file does not hold all of its bytes. */
uint64_t tiff_number(const Tiff *tiff, uint64_t at, unsigned width);

/* The numbers of one entry of the first directory; count 0: it has none. */
typedef struct TiffList {
    uint64_t at, count;
    unsigned width; /* bytes of one */
} TiffList;

TiffList tiff_list(const Tiff *tiff, unsigned tag);
