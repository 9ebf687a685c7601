/* SPDX-License-Identifier: Apache-2.0 */
/* tensor_file.h -- named arrays of numbers in one file ("tensor_file" 1.0), the container of
 * the RGL material database.
 *
 * Memory   fields point into the file's bytes, which are the arena's. Threads: const once open.
 * Fails    with the file and the byte; counts are checked against the file's size.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"

#define TENSOR_RANK_MAX 8
#define TENSOR_FIELDS_MAX 64

typedef struct TensorField {
    const char *name;
    int type; /* its number in the file */
    int rank;
    size_t shape[TENSOR_RANK_MAX];
    size_t count; /* product of the shape */
    const unsigned char *data;
} TensorField;

typedef struct TensorFile {
    const char *file;
    TensorField field[TENSOR_FIELDS_MAX];
    int fields;
} TensorFile;

/* Do the first bytes of a file hold this name among its fields? */
bool tensor_file_head_has(const char *head, size_t size, const char *name);

bool tensor_file_open(const char *file, Arena *arena, TensorFile *out, Error *err);

/* NULL: none of that name. */
const TensorField *tensor_file_find(const TensorFile *in, const char *name);

/* The field of that name and rank, all of whose numbers are finite; or an error. */
bool tensor_file_field(const TensorFile *in, const char *name, int rank, const TensorField **out,
                       Error *err);

/* Number i of the field; i below count. */
double tensor_value(const TensorField *field, size_t i);
