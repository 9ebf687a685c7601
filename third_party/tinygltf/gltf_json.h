/* SPDX-License-Identifier: Apache-2.0 */
/* gltf_json.h -- a glTF document as a tree of plain values, and its accessors as arrays.
 * The only C view of tinygltf (and of the JSON parser beneath it) in this program.
 *
 * Memory   everything is copied into the arena that is passed in; nothing to free.
 * Threads  no shared state.
 * Fails    with the JSON parser's line and column; no C++ exception crosses.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum GltfKind {
    GLTF_NULL,
    GLTF_BOOLEAN,
    GLTF_NUMBER,
    GLTF_STRING,
    GLTF_ARRAY,
    GLTF_OBJECT
} GltfKind;

/* One value of the document. Knows its place, so that a message can name it. */
typedef struct GltfValue {
    GltfKind kind;
    int index;                      /* place among the parent's items */
    const char *key;                /* name in the parent object, NULL elsewhere */
    const struct GltfValue *parent; /* NULL for the document itself */
    double number;                  /* finite; a boolean's 0 or 1 */
    const char *text;               /* UTF-8, never NULL; "" unless a string */
    const struct GltfValue *items;  /* of an array or object, in the file's order */
    int count;
} GltfValue;

#define GLTF_MAX_DEPTH 256        /* of nested arrays and objects */
#define GLTF_MAX_VALUES (1 << 25) /* in a document: a million nodes have some 20 million */

/* Parses JSON text (no nesting above GLTF_MAX_DEPTH, at most GLTF_MAX_VALUES values, no name
 * twice in one object, no zero character in a name or text: neither may end early). */
bool gltf_json_parse(const char *text, size_t size, Arena *arena, const GltfValue **root,
                     Error *err);

typedef struct GltfBufferView {
    int buffer;
    size_t offset, length;
    size_t stride; /* bytes, 0: as tight as the accessor's elements are */
} GltfBufferView;

typedef struct GltfAccessor {
    int buffer_view; /* -1: all zero (before the sparse values) */
    size_t offset, count;
    int component_type;  /* 5120 ... 5126 */
    int component_count; /* 1 ... 4; a matrix's columns times rows; 0: of a type or component
                            that glTF 2.0 does not have, nothing else is set */
    int matrix_rows;     /* 2, 3, 4 of a matrix; 0 otherwise */
    bool is_normalized;
    size_t sparse_count; /* 0: not sparse */
    int sparse_index_view, sparse_index_type, sparse_value_view;
    size_t sparse_index_offset, sparse_value_offset;
} GltfAccessor;

typedef struct GltfData {
    const GltfBufferView *views;
    const GltfAccessor *accessors;
    int view_count, accessor_count;
} GltfData;

/* Lets tinygltf read the buffer views and accessors of a parsed document that has been checked
 * against the specification before: tinygltf itself checks no references and no bounds. */
bool gltf_json_data(const GltfValue *root, Arena *arena, GltfData *out, Error *err);

#ifdef __cplusplus
}
#endif
