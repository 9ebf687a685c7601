/* SPDX-License-Identifier: Apache-2.0 */
#include "import/scatter/byte_scan.h"

#include <stdarg.h>
#include <string.h>

#include "base/file.h"
#include "import/set/import.h"

bool byte_scan_open(const char *file, Arena *arena, ByteScan *out, Error *err) {
    FileBytes bytes;
    if (!file_read(file, IMPORT_FILE_BYTES_MAX, arena, &bytes, err)) return false;
    *out = (ByteScan){file, bytes.data, bytes.size, 0};
    return true;
}

const unsigned char *byte_scan_take(ByteScan *scan, size_t count) {
    if (count > scan->size - scan->at) return NULL;
    const unsigned char *bytes = scan->data + scan->at;
    scan->at += count;
    return bytes;
}

bool byte_scan_uint(ByteScan *scan, size_t bytes, uint64_t *out) {
    const unsigned char *at = byte_scan_take(scan, bytes);
    if (at) *out = uint_from_bytes(at, bytes);
    return at != NULL;
}

bool byte_scan_double(ByteScan *scan, double *out) {
    const unsigned char *at = byte_scan_take(scan, sizeof *out);
    if (at) *out = double_from_bytes(at);
    return at != NULL;
}

bool byte_scan_fail(const ByteScan *scan, Error *err, const char *format, ...) {
    va_list list;
    va_start(list, format);
    error_at_count(err, scan->file, "byte", (long)scan->at, format, list);
    va_end(list);
    return false;
}

uint64_t uint_from_bytes(const unsigned char *bytes, size_t size) {
    uint64_t value = 0;
    while (size-- > 0) value = value << 8 | bytes[size];
    return value;
}

float float_from_bytes(const unsigned char *bytes) {
    uint32_t bits = (uint32_t)uint_from_bytes(bytes, sizeof bits);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double double_from_bytes(const unsigned char *bytes) {
    uint64_t bits = uint_from_bytes(bytes, sizeof bits);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
