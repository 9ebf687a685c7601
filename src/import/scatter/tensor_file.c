/* SPDX-License-Identifier: Apache-2.0 */
#include "import/scatter/tensor_file.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "import/scatter/byte_scan.h"

#define MAGIC "tensor_file" /* with its final zero */

typedef enum TensorType {
    TENSOR_U8 = 1,
    TENSOR_I8,
    TENSOR_U16,
    TENSOR_I16,
    TENSOR_U32,
    TENSOR_I32,
    TENSOR_U64,
    TENSOR_I64,
    TENSOR_F16,
    TENSOR_F32,
    TENSOR_F64
} TensorType;

static size_t type_size(int type) {
    static const unsigned char size[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    return type >= TENSOR_U8 && type <= TENSOR_F64 ? size[type] : 0;
}

/* Halves and signed integers stand in no file of these kinds. */
double tensor_value(const TensorField *field, size_t i) {
    const unsigned char *at = field->data + i * type_size(field->type);
    switch (field->type) {
    case TENSOR_F32: return (double)float_from_bytes(at);
    case TENSOR_F64: return double_from_bytes(at);
    default: return (double)uint_from_bytes(at, type_size(field->type));
    }
}

static bool is_readable(int type) {
    return type == TENSOR_U8 || type == TENSOR_U16 || type == TENSOR_U32 || type == TENSOR_U64 ||
           type == TENSOR_F32 || type == TENSOR_F64;
}

/* The product of the shape, which the rest of the file must be able to hold. */
static bool place_data(const ByteScan *scan, TensorField *field, uint64_t offset, Error *err) {
    size_t each = type_size(field->type);
    if (!each)
        return byte_scan_fail(scan, err,
                              "field '%s' has a type of number %d, required: 1 to "
                              "11",
                              field->name, field->type);
    if (offset > scan->size)
        return byte_scan_fail(scan, err, "field '%s' begins behind the file's end", field->name);
    size_t room = (scan->size - (size_t)offset) / each;
    field->count = 1;
    for (int d = 0; d < field->rank; d++) {
        if (field->shape[d] && field->count > room / field->shape[d])
            return byte_scan_fail(scan, err, "field '%s' is larger than the file", field->name);
        field->count *= field->shape[d];
    }
    field->data = scan->data + offset;
    return true;
}

static bool read_field(ByteScan *scan, Arena *arena, TensorField *field, Error *err) {
    uint64_t length, rank, type, offset, side;
    const unsigned char *name;
    if (!byte_scan_uint(scan, 2, &length) || !(name = byte_scan_take(scan, (size_t)length)) ||
        !byte_scan_uint(scan, 2, &rank) || !byte_scan_uint(scan, 1, &type) ||
        !byte_scan_uint(scan, 8, &offset))
        return byte_scan_fail(scan, err, "the file ends inside its list of fields");
    *field = (TensorField){.name = arena_string(arena, (const char *)name, (size_t)length),
                           .type = (int)type,
                           .rank = (int)rank};
    if (field->rank > TENSOR_RANK_MAX)
        return byte_scan_fail(scan, err,
                              "field '%.40s' has %d dimensions, required: at most "
                              "%d",
                              field->name, field->rank, TENSOR_RANK_MAX);
    for (int d = 0; d < field->rank; d++) {
        if (!byte_scan_uint(scan, 8, &side))
            return byte_scan_fail(scan, err, "the file ends inside its list of fields");
        field->shape[d] = (size_t)side;
    }
    return place_data(scan, field, offset, err);
}

bool tensor_file_head_has(const char *head, size_t size, const char *name) {
    size_t first = sizeof MAGIC + 6, length = strlen(name); /* behind version and count */
    if (size < first || memcmp(head, MAGIC, sizeof MAGIC)) return false;
    for (size_t i = first; i + length <= size; i++)
        if (!memcmp(head + i, name, length)) return true;
    return false;
}

bool tensor_file_open(const char *file, Arena *arena, TensorFile *out, Error *err) {
    ByteScan scan;
    uint64_t version, count;
    *out = (TensorFile){.file = file};
    if (!byte_scan_open(file, arena, &scan, err)) return false;
    const unsigned char *magic = byte_scan_take(&scan, sizeof MAGIC);
    if (!magic || memcmp(magic, MAGIC, sizeof MAGIC))
        return error_at(err, ERROR_INPUT, file, "",
                        "is no tensor file: it does not begin with "
                        "'tensor_file'");
    if (!byte_scan_uint(&scan, 2, &version) || !byte_scan_uint(&scan, 4, &count))
        return byte_scan_fail(&scan, err, "the file ends inside its header");
    if (version != 1)
        return byte_scan_fail(&scan, err, "the version is %d.%d, required: 1.0", (int)version & 255,
                              (int)version >> 8);
    if (count > TENSOR_FIELDS_MAX)
        return byte_scan_fail(&scan, err, "there are %u fields, required: at most %d",
                              (unsigned)count, TENSOR_FIELDS_MAX);
    for (; out->fields < (int)count; out->fields++)
        if (!read_field(&scan, arena, &out->field[out->fields], err)) return false;
    return true;
}

const TensorField *tensor_file_find(const TensorFile *in, const char *name) {
    for (int i = 0; i < in->fields; i++)
        if (!strcmp(in->field[i].name, name)) return &in->field[i];
    return NULL;
}

bool tensor_file_field(const TensorFile *in, const char *name, int rank, const TensorField **out,
                       Error *err) {
    const TensorField *field = tensor_file_find(in, name);
    if (!field) return error_at(err, ERROR_INPUT, in->file, name, "this field is missing");
    if (field->rank != rank)
        return error_at(err, ERROR_INPUT, in->file, name, "has %d dimensions, required: %d",
                        field->rank, rank);
    if (!is_readable(field->type))
        return error_at(err, ERROR_INPUT, in->file, name,
                        "has numbers of type %d, required: "
                        "floats or unsigned integers",
                        field->type);
    for (size_t i = 0; i < field->count; i++)
        if (!isfinite(tensor_value(field, i)))
            return error_at(err, ERROR_INPUT, in->file, name, "number %zu is not finite", i + 1);
    *out = field;
    return true;
}
