#include "import/scatter/byte_scan.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "import/set/import.h"

bool byte_scan_open(const char *file, Arena *arena, ByteScan *out, Error *err)
{
    FileBytes bytes;
    if (!file_read(file, IMPORT_FILE_BYTES_MAX, arena, &bytes, err)) return false;
    *out = (ByteScan){file, bytes.data, bytes.size, 0};
    return true;
}

const unsigned char *byte_scan_take(ByteScan *scan, size_t count)
{
    if (count > scan->size - scan->at) return NULL;
    const unsigned char *bytes = scan->data + scan->at;
    scan->at += count;
    return bytes;
}

static bool take_number(ByteScan *scan, size_t size, uint64_t *out)
{
    const unsigned char *bytes = byte_scan_take(scan, size);
    if (!bytes) return false;
    *out = 0;
    for (size_t i = size; i-- > 0;) *out = *out << 8 | bytes[i];
    return true;
}

bool byte_scan_u8(ByteScan *scan, uint8_t *out)
{
    uint64_t value;
    if (!take_number(scan, sizeof *out, &value)) return false;
    *out = (uint8_t)value;
    return true;
}

bool byte_scan_u16(ByteScan *scan, uint16_t *out)
{
    uint64_t value;
    if (!take_number(scan, sizeof *out, &value)) return false;
    *out = (uint16_t)value;
    return true;
}

bool byte_scan_u32(ByteScan *scan, uint32_t *out)
{
    uint64_t value;
    if (!take_number(scan, sizeof *out, &value)) return false;
    *out = (uint32_t)value;
    return true;
}

bool byte_scan_u64(ByteScan *scan, uint64_t *out)
{
    return take_number(scan, sizeof *out, out);
}

bool byte_scan_double(ByteScan *scan, double *out)
{
    uint64_t value;
    if (!take_number(scan, sizeof value, &value)) return false;
    memcpy(out, &value, sizeof value);
    return true;
}

bool byte_scan_fail(const ByteScan *scan, Error *err, const char *format, ...)
{
    char    text[512], place[32];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    snprintf(place, sizeof place, "byte %zu", scan->at);
    return error_at(err, ERROR_INPUT, scan->file, place, "%s", text);
}

float float_from_bytes(const unsigned char *bytes)
{
    uint32_t bits = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
                    (uint32_t)bytes[3] << 24;
    float    value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double double_from_bytes(const unsigned char *bytes)
{
    uint64_t bits = 0;
    double   value;
    for (int i = 8; i-- > 0;) bits = bits << 8 | bytes[i];
    memcpy(&value, &bits, sizeof value);
    return value;
}
