/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_fields.h"

#include <limits.h>
#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/mathd.h"
#include "text/nearest_word.h"
#include "text/uri.h"

#define FILES_MAX 256
#define NAMES_MAX 1000
#define LENGTH_LEAST 1e-9 /* shorter vectors have no direction */

bool field_fails(const JsonView *view, const char *key, Error *err, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    error_at_list(err, ERROR_INPUT, view->file, json_view_path(view, key), format, list);
    va_end(list);
    return false;
}

bool field_wanted(const JsonView *view, const char *key, Error *err)
{
    return json_object_get(view->object, key) != NULL ||
           error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing", key);
}

/* ---- single values ----------------------------------------------------------------------- */

bool field_boolean(const JsonView *view, const char *key, bool *out, Error *err)
{
    const json_t *value = json_object_get(view->object, key);
    if (!value) return true;
    if (!json_is_boolean(value))
        return json_view_wrong_kind(view, key, value, "true or false", err);
    *out = json_is_true(value);
    return true;
}

bool field_integer(const JsonView *view, const char *key, FieldBounds bounds, int *out,
                   Error *err)
{
    double value = *out;
    if (!json_view_number(view, key, bounds.low, bounds.high, &value, err)) return false;
    if (value != floor(value))
        return field_fails(view, key, err, "is %g, required: a whole number", value);
    *out = (int)value;
    return true;
}

bool field_choice(const JsonView *view, const char *key, FieldWords words, int *out, Error *err)
{
    const char *text = NULL;
    char        advice[256];
    if (!json_view_text(view, key, &text, err)) return false;
    if (!text) return true;
    for (int i = 0; i < words.count; i++)
        if (!strcmp(text, words.word[i])) {
            *out = i;
            return true;
        }
    return field_fails(view, key, err, "is '%.60s', required: another word: %s", text,
                       nearest_word_advice(text, words.word, words.count, advice,
                                           sizeof advice));
}

bool field_name(const JsonView *view, const char *key, const char **out, Error *err)
{
    if (!field_wanted(view, key, err) || !json_view_text(view, key, out, err)) return false;
    return **out || field_fails(view, key, err, "is empty, required: a name");
}

/* ---- vectors ----------------------------------------------------------------------------- */

bool field_numbers(const JsonView *view, const char *key, JsonRange range, double *out,
                   bool *found, Error *err)
{
    const json_t *list = json_object_get(view->object, key);
    int           length = 0;
    if (found) *found = list != NULL;
    if (json_is_array(list) && json_array_size(list) != (size_t)range.capacity)
        return field_fails(view, key, err, "has %zu values, required: "
                           "%d", json_array_size(list),
                           range.capacity);
    return json_view_numbers(view, key, range, out, &length, err);
}

bool field_unit_vector(const JsonView *view, const char *key, double out[3], bool *found,
                     Error *err)
{
    double vector[3];
    bool   is_there;
    if (!field_numbers(view, key, (JsonRange){-1e6, 1e6, 3}, vector, &is_there, err))
        return false;
    if (found) *found = is_there;
    if (!is_there) return true;
    double length = hypot_d(hypot_d(vector[0], vector[1]), vector[2]);
    if (!(length > LENGTH_LEAST))
        return field_fails(view, key, err, "is the zero vector, required: a direction");
    for (int i = 0; i < 3; i++) out[i] = vector[i] / length;
    return true;
}

/* ---- lists and objects by name ----------------------------------------------------------- */

bool field_list(const JsonView *view, const char *key, int most, int *count, Error *err)
{
    const json_t *list = json_object_get(view->object, key);
    *count = 0;
    if (!list) return true;
    if (!json_is_array(list)) return json_view_wrong_kind(view, key, list, "a list", err);
    size_t size = json_array_size(list);
    if (size < 1 || size > (size_t)most)
        return field_fails(view, key, err, "has %zu entries, required: 1 to %d", size, most);
    *count = (int)size;
    return true;
}

bool field_names(const JsonView *view, const char *key, const char *what, const char ***out,
                 int *count, Error *err)
{
    int length;
    if (!field_list(view, key, NAMES_MAX, &length, err)) return false;
    const char **names = ARENA_NEW(view->arena, const char *, length);
    for (int i = 0; i < length; i++) {
        const json_t *item = json_array_get(json_object_get(view->object, key), (size_t)i);
        if (!json_is_string(item))
            return json_view_wrong_kind(view, arena_format(view->arena, "%s/%d", key, i), item,
                                        what, err);
        names[i] = arena_string(view->arena, json_string_value(item), json_string_length(item));
    }
    *out = names;
    *count = length;
    return true;
}

bool field_item(const JsonView *view, const char *key, int i, FieldWords keys, JsonView *out,
                Error *err)
{
    json_t     *value = json_array_get(json_object_get(view->object, key), (size_t)i);
    const char *place = arena_format(view->arena, "%s/%d", key, i);
    if (!json_is_object(value))
        return json_view_wrong_kind(view, place, value, "an object", err);
    const char *path = json_view_path(view, place);
    *out = *view;
    out->object = value;
    out->path = path;
    return json_view_check_keys(out, keys.word, keys.count, err);
}

bool field_members(const JsonView *view, const char *key, int most, FieldMembers *out,
                   Error *err)
{
    FieldMembers members = {.count = 0};
    const char  *name;
    json_t      *value;
    if (!json_view_child(view, key, false, &members.view, err)) return false;
    size_t size = json_object_size(members.view.object);
    if (members.view.object && (size < 1 || size > (size_t)most))
        return field_fails(view, key, err, "has %zu members, required: 1 to %d", size, most);
    members.name = ARENA_NEW(view->arena, const char *, size);
    json_object_foreach(members.view.object, name, value) {
        if (!*name)
            return field_fails(view, key, err,
                               "has a member with an empty name, required: a name");
        members.name[members.count++] = arena_string(view->arena, name, strlen(name));
    }
    *out = members;
    return true;
}

FieldWords field_names_of(const void *structs, size_t size, int count, Arena *arena)
{
    const char **names = ARENA_NEW(arena, const char *, count);
    const char  *at = structs;
    for (int i = 0; i < count; i++, at += size) memcpy(&names[i], at, sizeof names[i]);
    return (FieldWords){names, count};
}

bool field_knows(const JsonView *view, const char *name, FieldWords names, const char *what,
                 Error *err)
{
    char advice[256];
    for (int i = 0; i < names.count; i++)
        if (!strcmp(names.word[i], name)) return true;
    return field_fails(view, name, err, "unknown %s; %s", what,
                       names.count ? nearest_word_advice(name, names.word, names.count, advice,
                                                         sizeof advice)
                                   : "the review has none");
}

bool field_named_members(const JsonView *view, const char *key, FieldWords names,
                         const char *what, FieldMembers *out, Error *err)
{
    FieldMembers members;
    if (!field_members(view, key, INT_MAX, &members, err)) return false;
    for (int i = 0; i < members.count; i++)
        if (!field_knows(&members.view, members.name[i], names, what, err)) return false;
    *out = members;
    return true;
}

/* ---- files ------------------------------------------------------------------------------- */

/* A URI of the document as a path: `place` is where it stands. */
static bool resolve(const JsonView *view, const char *place, const char *uri, const char **out,
                    Error *err)
{
    Error  why;
    char  *relative;
    size_t scheme = uri_scheme_length(uri);
    if (scheme)
        return field_fails(view, place, err, "has the scheme '%.*s:', required: a relative "
                           "path",
                           (int)(scheme < 40 ? scheme : 40), uri);
    if (!uri_decode(uri, view->arena, &relative, &why))
        return field_fails(view, place, err, "%s", why.text);
    if (!json_view_file(view, place, relative, out, err)) return false;
    return file_exists(*out) ||
           field_fails(view, place, err, "names '%.200s', which cannot be read; required: a "
                       "file",
                       *out);
}

bool field_file(const JsonView *view, const char *key, const char **out, Error *err)
{
    const char *uri = NULL;
    if (!json_view_text(view, key, &uri, err)) return false;
    return !uri || resolve(view, key, uri, out, err);
}

bool field_files(const JsonView *view, const char *key, const char ***out, int *count,
                 Error *err)
{
    int length;
    if (!field_list(view, key, FILES_MAX, &length, err)) return false;
    const char **paths = ARENA_NEW(view->arena, const char *, length);
    for (int i = 0; i < length; i++) {
        json_t *value = json_array_get(json_object_get(view->object, key), (size_t)i);
        const char *place = arena_format(view->arena, "%s/%d", key, i);
        if (!json_is_string(value))
            return json_view_wrong_kind(view, place, value, "a file's path", err);
        if (!resolve(view, place, json_string_value(value), &paths[i], err)) return false;
    }
    *out = paths;
    *count = length;
    return true;
}

/* ---- while it is read -------------------------------------------------------------------- */

#define INPUT_BYTES_MAX ((size_t)1 << 30)

void request_note_input(RequestReading *reading, const char *path, uint64_t hash)
{
    ReviewRequest *request = reading->request;
    for (int i = 0; i < request->input_count; i++)
        if (!strcmp(request->inputs[i].path, path)) return;
    if (request->input_count == reading->input_capacity) {
        reading->input_capacity = 2 * reading->input_capacity + 8;
        request->inputs = ARENA_GROW(reading->root.arena, ReviewInput, request->inputs,
                                     request->input_count, reading->input_capacity);
    }
    const char *kept = arena_string(reading->root.arena, path, strlen(path));
    request->inputs[request->input_count++] = (ReviewInput){kept, hash};
}

bool request_note_file(RequestReading *reading, const char *path, Error *err)
{
    FileBytes bytes;
    Arena     scratch = *reading->root.arena;
    if (!file_read(path, INPUT_BYTES_MAX, &scratch, &bytes, err)) return false;
    request_note_input(reading, path, XXH3_64bits(bytes.data, bytes.size));
    return true;
}

bool request_contents_read(const JsonView *view, ReviewContent **out, int *count, Error *err)
{
    FieldMembers members;
    if (!field_members(view, "contents", NAMES_MAX, &members, err)) return false;
    *out = ARENA_NEW(view->arena, ReviewContent, members.count);
    *count = members.count;
    for (int i = 0; i < members.count; i++) {
        (*out)[i].display = members.name[i];
        if (!field_file(&members.view, members.name[i], &(*out)[i].path, err)) return false;
    }
    return true;
}

FieldWords request_eye_names(const ReviewRequest *request, Arena *arena)
{
    return field_names_of(request->eyes, sizeof *request->eyes, request->eye_count, arena);
}

FieldWords request_level_names(const ReviewRequest *request, Arena *arena)
{
    return field_names_of(request->levels, sizeof *request->levels, request->level_count,
                          arena);
}

bool request_find_name(const JsonView *view, const char *key, FieldWords names,
                       const char *what, int *out, Error *err)
{
    const char *name = NULL;
    char        advice[256];
    if (!json_view_text(view, key, &name, err)) return false;
    if (!name) return true;
    for (int i = 0; i < names.count; i++)
        if (!strcmp(names.word[i], name)) {
            *out = i;
            return true;
        }
    if (!names.count)
        return field_fails(view, key, err, "is '%.60s', but the file has no '%s'", name, what);
    return field_fails(view, key, err, "is '%.60s', required: a name of '%s': %s", name, what,
                       nearest_word_advice(name, names.word, names.count, advice,
                                           sizeof advice));
}
