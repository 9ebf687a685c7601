/* SPDX-License-Identifier: Apache-2.0 */
/* byte_scan.h -- walks over the bytes of a little-endian file; nothing is read beyond its end.
 *
 * Memory   the arena's. Threads: one scan per thread.
 * Fails    with the file and the byte's number.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"

typedef struct ByteScan {
    const char *file;
    const unsigned char *data;
    size_t size, at;
} ByteScan;

bool byte_scan_open(const char *file, Arena *arena, ByteScan *out, Error *err);

/* The next `count` bytes, or NULL. */
const unsigned char *byte_scan_take(ByteScan *scan, size_t count);

/* An unsigned number of so many bytes, at most 8. */
bool byte_scan_uint(ByteScan *scan, size_t bytes, uint64_t *out);

bool byte_scan_double(ByteScan *scan, double *out);

/* An error at the current byte. Always false. */
bool byte_scan_fail(const ByteScan *scan, Error *err, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Numbers at any address. */
uint64_t uint_from_bytes(const unsigned char *bytes, size_t size);
float float_from_bytes(const unsigned char *bytes);
double double_from_bytes(const unsigned char *bytes);
