/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/accessor.h"

#include <string.h>

#include "scene/gltf/document.h"

enum { TYPE_BYTE = 5120, TYPE_UBYTE, TYPE_SHORT, TYPE_USHORT, TYPE_INT, TYPE_UINT, TYPE_FLOAT };

size_t component_size(int component_type) {
    switch (component_type) {
    case TYPE_BYTE:
    case TYPE_UBYTE: return 1;
    case TYPE_SHORT:
    case TYPE_USHORT: return 2;
    case TYPE_UINT:
    case TYPE_FLOAT: return 4;
    default: return 0;
    }
}

const char *component_name(int component_type) {
    static const char *const NAMES[] = {
        "BYTE (5120)", "UNSIGNED_BYTE (5121)", "SHORT (5122)", "UNSIGNED_SHORT (5123)",
        "INT (5124)",  "UNSIGNED_INT (5125)",  "FLOAT (5126)"};
    bool is_known = component_type >= TYPE_BYTE && component_type <= TYPE_FLOAT;
    return is_known ? NAMES[component_type - TYPE_BYTE] : "unknown";
}

/* Bytes from one column of a matrix to the next: columns start at multiples of four. */
static size_t column_stride(const GltfAccessor *accessor) {
    size_t bytes = component_size(accessor->component_type) * (size_t)accessor->matrix_rows;
    return (bytes + 3) & ~(size_t)3;
}

size_t accessor_element_size(const GltfAccessor *accessor) {
    if (!accessor->matrix_rows)
        return component_size(accessor->component_type) * (size_t)accessor->component_count;
    return column_stride(accessor) * (size_t)(accessor->component_count / accessor->matrix_rows);
}

static size_t component_offset(const GltfAccessor *accessor, int component) {
    size_t size = component_size(accessor->component_type);
    if (!accessor->matrix_rows) return size * (size_t)component;
    return column_stride(accessor) * (size_t)(component / accessor->matrix_rows) +
           size * (size_t)(component % accessor->matrix_rows);
}

size_t accessor_element_extent(const GltfAccessor *accessor) {
    return component_offset(accessor, accessor->component_count - 1) +
           component_size(accessor->component_type);
}

double accessor_numbers(const GltfAccessor *accessor) {
    return (double)accessor->count * accessor->component_count;
}

bool accessor_is_float(const GltfAccessor *accessor) {
    return accessor->component_type == TYPE_FLOAT;
}

const GltfAccessor *accessor_get(const GltfFile *file, int accessor) {
    bool exists = accessor >= 0 && accessor < file->data.accessor_count;
    return exists ? &file->data.accessors[accessor] : NULL;
}

bool accessor_has_bytes(const GltfFile *file, const GltfAccessor *accessor) {
    const bool is_sparse = accessor->sparse_count > 0;
    return (accessor->buffer_view < 0 || document_view(file, accessor->buffer_view).data) &&
           (!is_sparse || (document_view(file, accessor->sparse_index_view).data &&
                           document_view(file, accessor->sparse_value_view).data));
}

bool accessor_claim_bytes(GltfFile *file, int accessor, const GltfValue *at, const char *what) {
    const GltfAccessor *claimed = accessor_get(file, accessor);
    return !claimed || accessor_has_bytes(file, claimed) ||
           file_error(file, at, "the bytes of %s are missing: their buffer is not there", what);
}

static inline uint32_t integer_at(const unsigned char *bytes, int component_type) {
    switch (component_type) {
    case TYPE_BYTE: return (uint32_t)(int32_t)(int8_t)bytes[0];
    case TYPE_UBYTE: return bytes[0];
    case TYPE_SHORT: return (uint32_t)(int32_t)(int16_t)(bytes[0] | bytes[1] << 8);
    case TYPE_USHORT: return (uint32_t)(bytes[0] | bytes[1] << 8);
    default:
        return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
               (uint32_t)bytes[3] << 24;
    }
}

/* glTF 2.0, 3.6.2.2 and 3.11: c / 127, c / 255 ..., signed ones not below -1. */
static float float_at(const unsigned char *bytes, int component_type, bool is_normalized) {
    uint32_t bits = integer_at(bytes, component_type);
    float value;
    switch (component_type) {
    case TYPE_FLOAT: memcpy(&value, &bits, sizeof value); return value;
    case TYPE_BYTE:
    case TYPE_SHORT: value = (float)(int32_t)bits; break;
    default: value = (float)bits; break;
    }
    if (!is_normalized) return value;
    switch (component_type) {
    case TYPE_BYTE: value /= 127.0f; break;
    case TYPE_UBYTE: value /= 255.0f; break;
    case TYPE_SHORT: value /= 32767.0f; break;
    default: value /= 65535.0f; break;
    }
    return value < -1 ? -1.0f : value;
}

typedef enum Decoding { TO_FLOATS, TO_RAW_FLOATS, TO_INTEGERS } Decoding;

/* One element's components to `out`, floats or integers. */
static void decode_element(const GltfAccessor *accessor, const unsigned char *bytes,
                           Decoding decoding, void *out) {
    bool is_normalized = accessor->is_normalized && decoding == TO_FLOATS;
    for (int c = 0; c < accessor->component_count; c++) {
        const unsigned char *at = bytes + component_offset(accessor, c);
        if (decoding == TO_INTEGERS)
            ((uint32_t *)out)[c] = integer_at(at, accessor->component_type);
        else ((float *)out)[c] = float_at(at, accessor->component_type, is_normalized);
    }
}

uint32_t *accessor_sparse_indices(GltfFile *file, const GltfAccessor *accessor) {
    const unsigned char *bytes = document_view(file, accessor->sparse_index_view).data;
    size_t size = component_size(accessor->sparse_index_type);
    if (!bytes) return NULL;
    uint32_t *indices = ARENA_NEW(&file->load->scratch, uint32_t, accessor->sparse_count);
    bytes += accessor->sparse_index_offset;
    for (size_t i = 0; i < accessor->sparse_count; i++)
        indices[i] = integer_at(bytes + i * size, accessor->sparse_index_type);
    return indices;
}

static void decode_sparse(GltfFile *file, const GltfAccessor *accessor, Decoding decoding,
                          char *out) {
    const uint32_t *indices = accessor_sparse_indices(file, accessor);
    const unsigned char *values = document_view(file, accessor->sparse_value_view).data;
    size_t size = accessor_element_size(accessor), row = 4 * (size_t)accessor->component_count;
    if (!indices || !values) return;
    values += accessor->sparse_value_offset;
    for (size_t i = 0; i < accessor->sparse_count; i++)
        if (indices[i] < accessor->count)
            decode_element(accessor, values + i * size, decoding, out + indices[i] * row);
}

/* Numbers that are kept as they stand: floats, and integers of four bytes. glTF's are little
 * endian. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "floats are copied as they stand");
static bool is_copied(const GltfAccessor *accessor, Decoding decoding) {
    int type = accessor->component_type;
    return !accessor->matrix_rows &&
           (type == TYPE_FLOAT || (type == TYPE_UINT && decoding == TO_INTEGERS));
}

/* Large files are almost all floats and indices: those take the short ways. */
static void decode_elements(const GltfAccessor *accessor, const unsigned char *bytes, size_t stride,
                            Decoding decoding, char *out) {
    size_t count = accessor->count, row = 4 * (size_t)accessor->component_count;
    if (is_copied(accessor, decoding) && stride == row) memcpy(out, bytes, count * row);
    else if (is_copied(accessor, decoding))
        for (size_t i = 0; i < count; i++) memcpy(out + i * row, bytes + i * stride, row);
    else if (decoding == TO_INTEGERS && row == 4 && accessor->component_type == TYPE_USHORT)
        for (size_t i = 0; i < count; i++)
            ((uint32_t *)(void *)out)[i] = integer_at(bytes + i * stride, TYPE_USHORT);
    else
        for (size_t i = 0; i < count; i++)
            decode_element(accessor, bytes + i * stride, decoding, out + i * row);
}

static void *decode(GltfFile *file, int accessor_id, Decoding decoding) {
    const GltfAccessor *accessor = accessor_get(file, accessor_id);
    size_t row = 4 * (size_t)accessor->component_count;
    char *out = arena_alloc(&file->load->scratch, row, 16, accessor->count);
    FileBytes bytes = {0};
    if (accessor->buffer_view >= 0) bytes = document_view(file, accessor->buffer_view);
    if (bytes.data) {
        size_t stride = file->data.views[accessor->buffer_view].stride;
        if (!stride) stride = accessor_element_size(accessor);
        decode_elements(accessor, bytes.data + accessor->offset, stride, decoding, out);
    }
    if (accessor->sparse_count) decode_sparse(file, accessor, decoding, out);
    return out;
}

float *accessor_floats(GltfFile *file, int accessor) {
    return decode(file, accessor, TO_FLOATS);
}

float *accessor_raw_floats(GltfFile *file, int accessor) {
    return decode(file, accessor, TO_RAW_FLOATS);
}

uint32_t *accessor_integers(GltfFile *file, int accessor) {
    return decode(file, accessor, TO_INTEGERS);
}
