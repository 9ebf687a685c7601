/* SPDX-License-Identifier: Apache-2.0 */
#include "text/json_view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/reference.h"
#include "text/nearest_word.h"

const char *json_view_path(const JsonView *view, const char *key)
{
    return arena_format(view->arena, "%s/%s", view->path, key);
}

static const char *kind_of(const json_t *value)
{
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

bool json_view_open(const char *file, Arena *arena, JsonView *out, Error *err)
{
    FileBytes bytes;
    if (!file_read(file, JSON_FILE_BYTES_MAX, arena, &bytes, err)) return false;
    json_error_t fault;
    json_t *root = json_loadb((const char *)bytes.data, bytes.size, JSON_REJECT_DUPLICATES,
                              &fault);
    if (!root) {
        char place[64];
        snprintf(place, sizeof place, "line %d", fault.line);
        return error_at(err, ERROR_INPUT, file, place, "not valid JSON: %s", fault.text);
    }
    if (!json_is_object(root)) {
        bool fails = error_at(err, ERROR_INPUT, file, "", "is %s, required: an object",
                              kind_of(root));
        json_decref(root);
        return fails;
    }
    *out = (JsonView){.object = root, .file = arena_string(arena, file, strlen(file)),
                      .path = "", .arena = arena, .hash = XXH3_64bits(bytes.data, bytes.size)};
    return true;
}

void json_view_close(JsonView *root)
{
    json_decref(root->object);
    root->object = NULL;
}

bool json_view_check_keys(const JsonView *view, const char *const *known, int count,
                          Error *err)
{
    const char *key;
    json_t     *value;
    if (!view->object) return true;
    json_object_foreach(view->object, key, value) {
        bool found = false;
        for (int i = 0; i < count && !found; i++) found = !strcmp(key, known[i]);
        if (found) continue;
        const char *meant = nearest_word_meant(key, known, count); /* "age" is "age_years" */
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "unknown key; the nearest known one is '%s'",
                        meant ? meant : nearest_word(key, known, count));
    }
    return true;
}

bool json_view_wrong_kind(const JsonView *view, const char *key, const json_t *value,
                          const char *wanted, Error *err)
{
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                    "is %s, required: %s", kind_of(value), wanted);
}

bool json_view_child(const JsonView *view, const char *key, bool required, JsonView *out,
                     Error *err)
{
    json_t *value = json_object_get(view->object, key);
    if (!value && required)
        return error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing", key);
    if (value && !json_is_object(value))
        return json_view_wrong_kind(view, key, value, "an object", err);
    const char *path = json_view_path(view, key);
    *out = *view;
    out->object = value;
    out->path = path;
    return true;
}

bool json_view_file(const JsonView *view, const char *key, const char *text, const char **out,
                    Error *err)
{
    Error why;
    if (!reference_resolve(view->file, text, (ReferenceReach){view->root, false}, view->arena,
                           out, &why))
        return error_at(err, why.code, view->file, json_view_path(view, key), "%s", why.text);
    if (view->named) lines_put(view->named, *out);
    return true;
}

static bool in_range(const JsonView *view, const char *key, double value,
                     const double limits[2], Error *err)
{
    if (isfinite(value) && value >= limits[0] && value <= limits[1]) return true;
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                    "is %g, required: a number from %g to %g", value, limits[0], limits[1]);
}

bool json_view_number(const JsonView *view, const char *key, double low, double high,
                      double *out, Error *err)
{
    json_t *value = json_object_get(view->object, key);
    if (!value) return true;
    if (!json_is_number(value)) return json_view_wrong_kind(view, key, value, "a number", err);
    if (!in_range(view, key, json_number_value(value), (double[2]){low, high}, err))
        return false;
    *out = json_number_value(value);
    return true;
}

bool json_view_numbers(const JsonView *view, const char *key, JsonRange range, double *out,
                       int *count, Error *err)
{
    double  limits[2] = {range.low, range.high};
    json_t *list = json_object_get(view->object, key);
    if (!list) return true;
    if (!json_is_array(list))
        return json_view_wrong_kind(view, key, list, "an array of numbers", err);
    int length = (int)json_array_size(list);
    if (length < 1 || length > range.capacity)
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "has %d values, required: 1 to %d", length, range.capacity);
    for (int i = 0; i < length; i++) {
        json_t *value = json_array_get(list, (size_t)i);
        if (!json_is_number(value))
            return json_view_wrong_kind(view, key, value, "only numbers", err);
        if (!in_range(view, key, json_number_value(value), limits, err)) return false;
    }
    for (int i = 0; i < length; i++)
        out[i] = json_number_value(json_array_get(list, (size_t)i));
    *count = length;
    return true;
}

bool json_view_text(const JsonView *view, const char *key, const char **out, Error *err)
{
    json_t *value = json_object_get(view->object, key);
    if (!value) return true;
    if (!json_is_string(value)) return json_view_wrong_kind(view, key, value, "a text", err);
    *out = arena_string(view->arena, json_string_value(value), json_string_length(value));
    return true;
}
