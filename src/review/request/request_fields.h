/* SPDX-License-Identifier: Apache-2.0 */
/* request_fields.h -- kinds of members of REVIEW.json that text/json_view.h does not read:
 * lists, objects by name, words out of a few, directions, files.
 *
 * Absent members leave *out as it is unless they are marked as wanted.
 *
 * Memory   the view's arena. Threads: one at a time.
 * Fails    with file and JSON path, as json_view.h.
 */
#pragma once
#include "base/count.h"
#include "base/problems.h"
#include "review/request/request.h"
#include "scene/gltf/tree.h"
#include "text/json_view.h"

typedef struct FieldBounds {
    int low, high;
} FieldBounds;

/* The words of a choice, in the order of its enum. */
typedef struct FieldWords {
    const char *const *word;
    int                count;
} FieldWords;

/* Reports a fault of a member; the format is "..., required: ...". Always false. */
bool field_fails(const JsonView *view, const char *key, Error *err, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* That there is such a key. */
bool field_wanted(const JsonView *view, const char *key, Error *err);

bool field_boolean(const JsonView *view, const char *key, bool *out, Error *err);
bool field_integer(const JsonView *view, const char *key, FieldBounds bounds, int *out,
                   Error *err);

/* The place of a text among words. */
bool field_choice(const JsonView *view, const char *key, FieldWords words, int *out,
                  Error *err);

/* Exactly range.capacity numbers in [low, high]; *found (may be NULL): they were there. */
bool field_numbers(const JsonView *view, const char *key, JsonRange range, double *out,
                   bool *found, Error *err);

/* Three numbers as a unit vector. */
bool field_unit_vector(const JsonView *view, const char *key, double out[3], bool *found,
                     Error *err);

/* A text with something in it; wanted. */
bool field_name(const JsonView *view, const char *key, const char **out, Error *err);

/* A list: *count items, 0 when it is absent. One that is there has some. */
bool field_list(const JsonView *view, const char *key, int most, int *count, Error *err);

/* A list of texts; what: such as "a node's name". */
bool field_names(const JsonView *view, const char *key, const char *what, const char ***out,
                 int *count, Error *err);

/* Item i of that list, an object with these keys only. */
bool field_item(const JsonView *view, const char *key, int i, FieldWords keys, JsonView *out,
                Error *err);

/* An object whose members' names are the user's: its members in the file's order. Absent:
 * *count is 0. One that is there has some, and none of their names is empty. */
typedef struct FieldMembers {
    JsonView     view; /* the object's */
    const char **name;
    int          count;
} FieldMembers;

bool field_members(const JsonView *view, const char *key, int most, FieldMembers *out,
                   Error *err);

/* Names that the request gives elsewhere: the first member of each of so many structs, each of
 * `size` bytes. */
FieldWords field_names_of(const void *structs, size_t size, int count, Arena *arena);

/* Is a name one of these? Else "unknown eye", where what is "eye", with the nearest. */
bool field_knows(const JsonView *view, const char *name, FieldWords names, const char *what,
                 Error *err);

/* field_members, each of which has one of these names. */
bool field_named_members(const JsonView *view, const char *key, FieldWords names,
                         const char *what, FieldMembers *out, Error *err);

/* The file that a URI under `key` means: relative, percent-encoded, readable. */
bool field_file(const JsonView *view, const char *key, const char **out, Error *err);

/* A list of such URIs; wanted and absent files are errors alike. */
bool field_files(const JsonView *view, const char *key, const char ***out, int *count,
                 Error *err);

/* ---- a REVIEW.json while it is being read ------------------------------------------------ */

/* What its parts are read from, and what they are put into. */
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

/* The names of all eyes, and of all levels. */
FieldWords request_eye_names(const ReviewRequest *request, Arena *arena);
FieldWords request_level_names(const ReviewRequest *request, Arena *arena);

/* What displays show instead: "contents". */
bool request_contents_read(const JsonView *view, ReviewContent **out, int *count, Error *err);

/* The index of a name in a list that is defined elsewhere in the document (`what`: "levels").
 * The error names what else there is. */
bool request_find_name(const JsonView *view, const char *key, FieldWords names,
                       const char *what, int *out, Error *err);
