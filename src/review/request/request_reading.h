/* SPDX-License-Identifier: Apache-2.0 */
/* request_reading.h -- a REVIEW.json while it is being read: what its parts are read from, and
 * what they are put into.
 *
 * Memory   the root view's arena. Threads: one at a time.
 */
#pragma once
#include "base/problems.h"
#include "review/request/request.h"
#include "review/request/request_fields.h"
#include "scene/gltf/tree.h"

typedef struct RequestReading {
    JsonView         root;
    const GltfValue *tree; /* the same document, for its environments */
    Problems        *problems;
    ReviewRequest   *request;
    int              input_capacity, weather_capacity;
} RequestReading;

/* A file that was read, once. */
void request_note_input(RequestReading *reading, const char *path, uint64_t hash);

/* The same, of a file whose bytes are to be hashed. */
bool request_note_file(RequestReading *reading, const char *path, Error *err);

/* The index of a name in a list that is defined elsewhere in the document (`what`: "levels").
 * The error names what else there is. */
bool request_find_name(const JsonView *view, const char *key, FieldWords names,
                       const char *what, int *out, Error *err);
