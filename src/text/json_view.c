/* SPDX-License-Identifier: Apache-2.0 */
#include "text/json_view.h"

#include <stdio.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/reference.h"

const char *json_view_path(const JsonView *view, const char *key) {
    return arena_format(view->arena, "%s/%s", view->path, key);
}

static const char *kind_of(const json_t *value) {
    switch (json_typeof(value)) {
    case JSON_OBJECT: return "an object";
    case JSON_ARRAY: return "an array";
    case JSON_STRING: return "a text";
    case JSON_NULL: return "null";
    case JSON_TRUE:
    case JSON_FALSE: return "true or false";
    default: return "a number";
    }
}

bool json_view_open(const char *file, Arena *arena, JsonView *out, Error *err) {
    FileBytes bytes;
    return file_read(file, JSON_FILE_BYTES_MAX, arena, &bytes, err) &&
           json_view_parse(file, bytes, arena, out, err);
}

bool json_view_parse(const char *file, FileBytes bytes, Arena *arena, JsonView *out, Error *err) {
    json_error_t fault;
    FileBytes text = file_unmarked(bytes);
    json_t *root = json_loadb((const char *)text.data, text.size, JSON_REJECT_DUPLICATES, &fault);
    if (!root) {
        char place[64];
        snprintf(place, sizeof place, "line %d", fault.line);
        return error_at(err, ERROR_INPUT, file, place, "not valid JSON: %s", fault.text);
    }
    if (!json_is_object(root)) {
        bool fails =
            error_at(err, ERROR_INPUT, file, "", "is %s, required: an object", kind_of(root));
        json_decref(root);
        return fails;
    }
    *out = (JsonView){.object = root,
                      .file = arena_string(arena, file, strlen(file)),
                      .path = "",
                      .arena = arena,
                      .hash = XXH3_64bits(bytes.data, bytes.size)};
    return true;
}

void json_view_close(JsonView *root) {
    json_decref(root->object);
    root->object = NULL;
}

bool json_view_wrong_kind(const JsonView *view, const char *key, const json_t *value,
                          const char *wanted, Error *err) {
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key), "is %s, required: %s",
                    kind_of(value), wanted);
}

bool json_view_child(const JsonView *view, const char *key, JsonView *out, Error *err) {
    json_t *value = json_object_get(view->object, key);
    if (!json_is_object(value)) return json_view_wrong_kind(view, key, value, "an object", err);
    const char *path = json_view_path(view, key);
    *out = *view;
    out->object = value;
    out->path = path;
    return true;
}

bool json_view_file(const JsonView *view, const char *key, const char *text, const char **out,
                    Error *err) {
    Error why;
    if (!reference_resolve(view->file, text, (ReferenceReach){view->root, false}, view->arena, out,
                           &why))
        return error_at(err, why.code, view->file, json_view_path(view, key), "%s", why.text);
    if (view->named) lines_put(view->named, *out);
    return true;
}
