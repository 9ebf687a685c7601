/* SPDX-License-Identifier: Apache-2.0 */
/* json_view.h -- typed, checked reading of one JSON object of a user's file.
 *
 * Every error names the file, the JSON path, what was found and what was wanted; an unknown
 * key names the nearest known one.
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
#include "base/lines.h"
#include "base/problems.h"

typedef struct JsonView {
    json_t     *object; /* NULL: the key was absent and everything keeps its default */
    const char *file;   /* as the user named it */
    const char *path;   /* JSON path of the object, "" for the root */
    Arena      *arena;
    const char *root;   /* a folder whose files it may name besides its own; NULL: none */
    Lines      *named;  /* gets the files that it names; NULL: nobody asks */
    uint64_t    hash;   /* XXH3 64 of the bytes that were read of the file; of no file 0 */
    Problems   *problems; /* gets warnings; NULL: nobody asks */
    void       *whole;    /* the outermost struct that is filled from it; NULL: the next one */
} JsonView;

#define JSON_FILE_BYTES_MAX ((size_t)64 << 20)

/* Reads a file that holds one JSON object; duplicate keys are refused. The root is NULL. */
bool json_view_open(const char *file, Arena *arena, JsonView *out, Error *err);
void json_view_close(JsonView *root);

/* Refuses a key that is not among the known ones. */
bool json_view_check_keys(const JsonView *view, const char *const *known, int count,
                          Error *err);

/* The object under a key. Absent: out->object is NULL, or an error when required. */
bool json_view_child(const JsonView *view, const char *key, bool required, JsonView *out,
                     Error *err);

/* A finite number in [low, high]; absent: *out keeps its value. */
bool json_view_number(const JsonView *view, const char *key, double low, double high,
                      double *out, Error *err);

/* The permitted size and values of an array of numbers. */
typedef struct JsonRange {
    double low, high;
    int    capacity; /* 1 to so many numbers */
} JsonRange;

/* An array of finite numbers; absent: out and *count keep their values. */
bool json_view_numbers(const JsonView *view, const char *key, JsonRange range, double *out,
                       int *count, Error *err);

/* A text; absent: *out keeps its value. */
bool json_view_text(const JsonView *view, const char *key, const char **out, Error *err);

/* The file that a text under `key` names, as seen from the document's folder
 * (base/reference.h); the text may differ from the key's own. */
bool json_view_file(const JsonView *view, const char *key, const char *text, const char **out,
                    Error *err);

/* Refuses what stands under a key: "is a number, required: a list of files". Always false. */
bool json_view_wrong_kind(const JsonView *view, const char *key, const json_t *value,
                          const char *wanted, Error *err);

/* JSON path of a member, from the arena. */
const char *json_view_path(const JsonView *view, const char *key);
