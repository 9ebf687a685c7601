/* SPDX-License-Identifier: Apache-2.0 */
/* json_view.h -- one JSON object of a user's file, and where it stands (record/record.h reads
 * its members).
 *
 * Every error names the file, the JSON path, what was found and what is required.
 *
 * Memory   texts are copied into the arena; the document itself is released by json_view_close.
 * Threads  one at a time.
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"
#include "base/file.h"
#include "base/lines.h"
#include "base/problems.h"

typedef struct JsonView {
    json_t *object;
    const char *file; /* as the user named it */
    const char *path; /* JSON path of the object, "" for the root */
    Arena *arena;
    const char *root;   /* a folder whose files it may name besides its own; NULL: none */
    Lines *named;       /* gets the files that it names; NULL: not needed */
    uint64_t hash;      /* XXH3 64 of the bytes that were read of the file; of no file 0 */
    Problems *problems; /* gets warnings; NULL: not needed */
    bool is_kept;       /* the program wrote it for itself (RECORD_KEPT) */
    void *whole;        /* the outermost struct that is filled from it; NULL: the next one */
} JsonView;

#define JSON_FILE_BYTES_MAX ((size_t)64 << 20)

/* Reads a file that holds one JSON object; duplicate keys are refused. The root is NULL. */
bool json_view_open(const char *file, Arena *arena, JsonView *out, Error *err);
/* The same of bytes that were read. */
bool json_view_parse(const char *file, FileBytes bytes, Arena *arena, JsonView *out, Error *err);
void json_view_close(JsonView *root);

/* The object under a key. */
bool json_view_child(const JsonView *view, const char *key, JsonView *out, Error *err);

/* The file that a text under `key` names, as seen from the document's folder
 * (base/reference.h); the text may differ from the key's own. */
bool json_view_file(const JsonView *view, const char *key, const char *text, const char **out,
                    Error *err);

/* Refuses what stands under a key: "is a number, required: a list of files". Always false. */
bool json_view_wrong_kind(const JsonView *view, const char *key, const json_t *value,
                          const char *wanted, Error *err);

/* JSON path of a member, from the arena. */
const char *json_view_path(const JsonView *view, const char *key);
