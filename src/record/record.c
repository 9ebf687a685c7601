/* SPDX-License-Identifier: Apache-2.0 */
#include "record/record.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "text/base64.h"
#include "text/nearest_word.h"
#include "text/removed.h"
#include "text/uri.h"

#define KEYS_MAX 256      /* of an object, and words of a choice */
#define LENGTH_LEAST 1e-9 /* shorter vectors have no direction */

bool record_fails(const JsonView *view, const char *key, Error *err, const char *format, ...) {
    va_list list;
    va_start(list, format);
    error_at_list(err, ERROR_INPUT, view->file, json_view_path(view, key), format, list);
    va_end(list);
    return false;
}

bool record_has(const JsonView *view, const char *key) {
    return json_object_get(view->object, key) != NULL;
}

bool record_misses(const JsonView *view, const char *key, Error *err) {
    return error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing", key);
}

bool record_one_of(const JsonView *view, const char *one, const char *other, Error *err) {
    bool has_one = record_has(view, one);
    return has_one != record_has(view, other) || error_at(err, ERROR_INPUT, view->file, view->path,
                                                          "has %s, required: one of '%s' and '%s'",
                                                          has_one ? "both" : "neither", one, other);
}

static void *at_offset(void *item, size_t offset) {
    return (char *)item + offset;
}

/* ---- numbers ----------------------------------------------------------------------------- */

static bool is_integer(const RecordRow *row) {
    return row->kind == RECORD_INTEGER || row->kind == RECORD_WHOLES;
}

const char record_infinite[] = "inf", record_infinite_below[] = "-inf";

static bool is_infinite(const RecordRow *row, const char *text, double *out) {
    bool is_above = text && !strcmp(text, record_infinite);
    bool is_below = text && !strcmp(text, record_infinite_below);
    if (is_integer(row) || row->high < HUGE_VAL || !(is_above || is_below)) return false;
    *out = is_above ? (double)INFINITY : -(double)INFINITY;
    return true;
}

/* Is it a number of the row's: in [low, high], whole? */
static bool check_number(const JsonView *view, const RecordRow *row, const json_t *value,
                         double *out, Error *err) {
    *out = (double)NAN;
    if (json_is_null(value) && row->flags & RECORD_NULL) return true;
    if (view->is_kept && is_infinite(row, json_string_value(value), out)) return true;
    if (!json_is_number(value))
        return json_view_wrong_kind(view, row->key, value, row->most ? "only numbers" : "a number",
                                    err);
    double number = *out = json_number_value(value);
    bool is_above = row->flags & RECORD_ABOVE;
    if (!isfinite(number) || number > row->high || (!is_above && number < row->low))
        return record_fails(view, row->key, err, "is %g, required: a number from %g to %g", number,
                            row->low, row->high);
    if (is_above && !(number > row->low))
        return record_fails(view, row->key, err, "is %g, required: a number above %g", number,
                            row->low);
    return (!is_integer(row) && !(row->flags & RECORD_WHOLE)) || number == floor(number) ||
           record_fails(view, row->key, err, "is %g, required: %s", number,
                        row->most ? "whole numbers" : "a whole number");
}

/* The i-th of them, as the row keeps it. */
static void keep_number(const RecordRow *row, void *at, int i, double value) {
    if (is_integer(row) && row->flags & RECORD_LONG) ((long *)at)[i] = (long)value;
    else if (is_integer(row)) ((int *)at)[i] = (int)value;
    else if (row->flags & RECORD_FLOAT) ((float *)at)[i] = (float)value;
    else ((double *)at)[i] = value;
}

static bool read_number(const JsonView *view, const RecordRow *row, void *out, Error *err) {
    double value;
    if (!check_number(view, row, json_object_get(view->object, row->key), &value, err))
        return false;
    if (row->flags & RECORD_RADIANS) value = radians_from_degrees(value);
    if (row->flags & RECORD_METRES) value /= 1000;
    keep_number(row, out, 0, value);
    return true;
}

static bool make_unit(const JsonView *view, const RecordRow *row, double *vector, Error *err) {
    double length = hypot_d(hypot_d(vector[0], vector[1]), vector[2]);
    if (!(length > LENGTH_LEAST))
        return record_fails(view, row->key, err, "is the zero vector, required: a direction");
    for (int i = 0; i < 3; i++) vector[i] /= length;
    return true;
}

/* How many items an array or object has. */
static bool find_count(const JsonView *view, const RecordRow *row, const char *what, int *count,
                       Error *err) {
    const json_t *list = json_object_get(view->object, row->key);
    bool is_map = row->kind == RECORD_MAP;
    if (is_map ? !json_is_object(list) : !json_is_array(list))
        return json_view_wrong_kind(view, row->key, list, what, err);
    const char *items = is_map ? "members" : "values";
    size_t size = is_map ? json_object_size(list) : json_array_size(list);
    size_t most = row->most ? (size_t)row->most : SIZE_MAX;
    *count = (int)size;
    if (size >= (size_t)row->least && size <= most) return true;
    if (row->least == row->most)
        return record_fails(view, row->key, err, "has %zu %s, required: %d", size, items,
                            row->least);
    return record_fails(view, row->key, err,
                        row->most ? "has %zu %s, required: %d to %d"
                                  : "has %zu %s, required: at least %d",
                        size, items, row->least, row->most);
}

static bool read_numbers(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    int count;
    void *at = at_offset(item, row->offset);
    const json_t *values = json_object_get(view->object, row->key);
    if (!find_count(view, row, "an array of numbers", &count, err)) return false;
    double *list = ARENA_NEW(view->arena, double, count);
    for (int i = 0; i < count; i++)
        if (!check_number(view, row, json_array_get(values, (size_t)i), &list[i], err))
            return false;
    if (row->flags & RECORD_UNIT && !make_unit(view, row, list, err)) return false;
    if (row->kind == RECORD_FIGURES) memcpy(at, &list, sizeof list);
    else
        for (int i = 0; i < count; i++) keep_number(row, at, i, list[i]);
    if (row->count) *(int *)at_offset(item, row->count) = count;
    return true;
}

static bool read_floats(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    const json_t *text = json_object_get(view->object, row->key);
    size_t size = 0, length = json_string_length(text), each = (size_t)row->most * sizeof(float);
    float *list = ARENA_NEW(view->arena, float, length / sizeof *list + 1);
    Error why;
    bool ok = base64_decode(json_string_value(text), length, (void *)list, &size, &why) &&
              size % each == 0;
    for (size_t i = 0; ok && i < size / sizeof *list; i++) ok = isfinite(list[i]);
    if (!ok || !text)
        return record_fails(view, row->key, err, "is no list of %d floats each, required: one",
                            row->most);
    memcpy(at_offset(item, row->offset), &list, sizeof list);
    *(int *)at_offset(item, row->count) = (int)(size / each);
    return true;
}

/* ---- words ------------------------------------------------------------------------------- */

/* A text that is no UTF-8 (record_write.h). */
static bool read_bytes(const JsonView *view, const RecordRow *row, const json_t *list,
                       const char **out, Error *err) {
    size_t count = json_array_size(list);
    char *text = ARENA_NEW(view->arena, char, count + 1);
    for (size_t i = 0; i < count; i++) {
        json_int_t byte = json_integer_value(json_array_get(list, i));
        if (byte < 1 || byte > UCHAR_MAX)
            return record_fails(view, row->key, err, "has the value %lld, required: a byte",
                                (long long)byte);
        text[i] = (char)byte;
    }
    *out = text;
    return true;
}

static bool read_text(const JsonView *view, const RecordRow *row, const char **out, Error *err) {
    const json_t *value = json_object_get(view->object, row->key);
    if (view->is_kept && json_is_array(value)) return read_bytes(view, row, value, out, err);
    if (!json_is_string(value)) return json_view_wrong_kind(view, row->key, value, "a text", err);
    *out = arena_string(view->arena, json_string_value(value), json_string_length(value));
    return !(row->flags & RECORD_FILLED) || **out ||
           record_fails(view, row->key, err, "is an empty text, required: some words");
}

const char *record_word(const RecordRow *row, int i) {
    const char *word;
    size_t stride = row->stride ? row->stride : sizeof *row->words;
    memcpy(&word, (const char *)row->words + (size_t)i * stride, sizeof word);
    return word;
}

/* The place of a word, and itself. */
static bool read_word(const JsonView *view, const RecordRow *row, int *place, const char **out,
                      Error *err) {
    const char *text, *word, *known[KEYS_MAX];
    char advice[256];
    int count = 0;
    if (!read_text(view, row, &text, err)) return false;
    for (; count < KEYS_MAX && (word = record_word(row, count)); count++) {
        known[count] = word;
        if (strcmp(text, word) != 0) continue;
        *place = count + (row->flags & RECORD_NULL ? 1 : 0);
        *out = word;
        return true;
    }
    return record_fails(view, row->key, err, "is '%.60s', required: another word: %s", text,
                        nearest_word_advice(text, known, count, advice, sizeof advice));
}

static bool read_const(const JsonView *view, const RecordRow *row, Error *err) {
    const json_t *value = json_object_get(view->object, row->key);
    const char *text = json_string_value(value);
    if (row->words ? !text : !json_is_number(value))
        return json_view_wrong_kind(view, row->key, value, row->words ? "a text" : "a number", err);
    if (row->words)
        return !strcmp(text, row->words[0]) ||
               record_fails(view, row->key, err, "is '%.60s', required: '%s'", text, row->words[0]);
    return json_number_value(value) == row->low ||
           record_fails(view, row->key, err, "is %g, required: %g", json_number_value(value),
                        row->low);
}

static bool read_file(const JsonView *view, const RecordRow *row, const char **out, Error *err) {
    Error why;
    const json_t *value = json_object_get(view->object, row->key);
    const char *uri = json_string_value(value);
    char *relative;
    if (!uri) return json_view_wrong_kind(view, row->key, value, "a file's path", err);
    size_t scheme = uri_scheme_length(uri);
    if (scheme)
        return record_fails(view, row->key, err,
                            "has the scheme '%.*s:', required: a relative path",
                            (int)(scheme < 40 ? scheme : 40), uri);
    if (!uri_decode(uri, view->arena, &relative, &why))
        return record_fails(view, row->key, err, "%s", why.text);
    if (!json_view_file(view, row->key, relative, out, err)) return false;
    return file_exists(*out) ||
           record_fails(view, row->key, err,
                        "names '%.200s', which cannot be read; required: a file", *out);
}

/* ---- names of other items ---------------------------------------------------------------- */

int record_names(const JsonView *view, const RecordNames *among, const char ***out) {
    const char *whole = view->whole, *item;
    int count = *(const int *)(whole + among->count);
    memcpy(&item, whole + among->list, sizeof item);
    *out = ARENA_NEW(view->arena, const char *, count);
    for (int i = 0; i < count; i++, item += among->size) memcpy(&(*out)[i], item, sizeof **out);
    return count;
}

static int place_of(const char *name, const char **names, int count) {
    for (int i = 0; i < count; i++)
        if (!strcmp(names[i], name)) return i;
    return -1;
}

static bool read_refer(const JsonView *view, const RecordRow *row, int *out, Error *err) {
    const char *name, **names, *key = row->among->key;
    char advice[256];
    if (!read_text(view, row, &name, err)) return false;
    int count = record_names(view, row->among, &names), place = place_of(name, names, count);
    if (place >= 0) {
        *out = place;
        return true;
    }
    if (!count)
        return record_fails(view, row->key, err, "is '%.60s', but the file has no '%s'", name, key);
    return record_fails(view, row->key, err, "is '%.60s', required: a name of '%s': %s", name, key,
                        nearest_word_advice(name, names, count, advice, sizeof advice));
}

/* A map's member has a name, one of the row's if it has some. */
static bool check_name(const JsonView *map, const RecordRow *row, const char *name, Error *err) {
    const char **names;
    char advice[256];
    if (!*name)
        return error_at(err, ERROR_INPUT, map->file, map->path,
                        "has a member with an empty name, required: a name");
    int count = row->among ? record_names(map, row->among, &names) : 0;
    return !row->among || place_of(name, names, count) >= 0 ||
           record_fails(map, name, err, "unknown %s; %s", row->among->one,
                        count ? nearest_word_advice(name, names, count, advice, sizeof advice)
                              : "the file has none");
}

/* ---- lists and maps ---------------------------------------------------------------------- */

/* A list as an object whose members' names are their places, for who reads members. */
static json_t *by_place(const json_t *list) {
    json_t *object = json_object(), *value;
    size_t i;
    char place[24];
    json_array_foreach(list, i, value) {
        snprintf(place, sizeof place, "%zu", i);
        json_object_set(object, place, value);
    }
    return object;
}

static bool read_item(const JsonView *view, const RecordRow *row, const char *name, void *item,
                      Error *err) {
    JsonView inside;
    const RecordFormat *of = row->of;
    const char *kept = NULL;
    if (row->kind == RECORD_MAP) memcpy(&kept, item, sizeof kept);
    if (of->start) of->start(item);
    if (row->kind == RECORD_MAP) {
        if (!check_name(view, row, name, err)) return false;
        memcpy(item, &kept, sizeof kept);
    }
    if (!of->value)
        return json_view_child(view, name, &inside, err) && record_read(&inside, of, item, err);
    RecordRow value = *of->value;
    value.key = name;
    return record_read_value(view, &value, item, err) && (!of->check || of->check(view, item, err));
}

static bool read_items(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    int count;
    JsonView inside = *view;
    json_t *value, *own = json_object_get(view->object, row->key);
    const char *name;
    bool ok = true;
    if (!find_count(view, row,
                    row->kind == RECORD_MAP ? "an object"
                    : row->of->value        ? "an array"
                                            : "an array of objects",
                    &count, err))
        return false;
    char *items = arena_try(view->arena, row->of->size, _Alignof(max_align_t), (size_t)count);
    if (!items) {
        record_fails(view, row->key, err, "has %d values, required: so few as memory holds", count);
        err->code = ERROR_MEMORY;
        return false;
    }
    memcpy(at_offset(item, row->offset), &items, sizeof items);
    *(int *)at_offset(item, row->count) = count;
    inside.path = json_view_path(view, row->key);
    inside.object = row->kind == RECORD_MAP ? json_incref(own) : by_place(own);
    char *named = items; /* all names before the first item, which may use them */
    if (row->kind == RECORD_MAP) json_object_foreach(own, name, value) {
            const char *kept = arena_string(view->arena, name, strlen(name));
            memcpy(named, &kept, sizeof kept);
            named += row->of->size;
        }
    json_object_foreach(inside.object, name, value) {
        ok = ok && read_item(&inside, row, name, items, err);
        items += row->of->size;
    }
    json_decref(inside.object);
    return ok;
}

static const RecordRow A_TEXT = {.kind = RECORD_TEXT}, A_FILE = {.kind = RECORD_FILE};
static const RecordFormat texts = {"text", sizeof(char *), .value = &A_TEXT};
const RecordFormat record_files = {"file", sizeof(char *), .value = &A_FILE};

static bool read_texts(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    RecordRow list = *row;
    list.of = &texts;
    return read_items(view, &list, item, err);
}

/* ---- objects and choices ----------------------------------------------------------------- */

static bool read_object(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    JsonView inside;
    void *at = at_offset(item, row->offset);
    if (!json_view_child(view, row->key, &inside, err)) return false;
    if (row->flags & RECORD_APART) {
        void *apart = arena_alloc(view->arena, row->of->size, _Alignof(max_align_t), 1);
        if (row->of->start) row->of->start(apart);
        memcpy(at, &apart, sizeof apart);
        at = apart;
    }
    if (!record_read(&inside, row->of, at, err)) return false;
    if (row->count) *(bool *)at_offset(item, row->count) = true;
    return true;
}

static bool read_flag(const JsonView *view, const RecordRow *row, bool *out, Error *err) {
    const json_t *value = json_object_get(view->object, row->key);
    if (!json_is_boolean(value))
        return json_view_wrong_kind(view, row->key, value, "true or false", err);
    *out = json_is_true(value);
    return true;
}

static bool is_of(const json_t *value, RecordKind kind) {
    switch (kind) {
    case RECORD_NUMBER:
    case RECORD_INTEGER: return json_is_number(value);
    case RECORD_FLAG: return json_is_boolean(value);
    case RECORD_OBJECT:
    case RECORD_MAP: return json_is_object(value);
    case RECORD_WHOLES:
    case RECORD_NUMBERS:
    case RECORD_FIGURES:
    case RECORD_TEXTS:
    case RECORD_LIST: return json_is_array(value);
    default: return json_is_string(value);
    }
}

static bool read_either(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    const char *required = "";
    const json_t *value = json_object_get(view->object, row->key);
    for (const RecordRow *form = row->forms; form->key; form++) {
        RecordRow own = *form;
        own.key = row->key;
        if (is_of(value, form->kind))
            return record_read_value(view, &own, at_offset(item, row->offset), err);
        required =
            arena_format(view->arena, "%s%s%s", required, *required ? " or " : "", form->key);
    }
    return json_view_wrong_kind(view, row->key, value, required, err);
}

bool record_read_kind(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    void *at = at_offset(item, row->offset);
    const char *word;
    int place;
    switch (row->kind) {
    case RECORD_NUMBER:
    case RECORD_INTEGER: return read_number(view, row, at, err);
    case RECORD_WHOLES:
    case RECORD_NUMBERS:
    case RECORD_FIGURES: return read_numbers(view, row, item, err);
    case RECORD_FLOATS: return read_floats(view, row, item, err);
    case RECORD_FLAG: return read_flag(view, row, at, err);
    case RECORD_TEXT: return read_text(view, row, at, err);
    case RECORD_NOTE: return read_text(view, row, &word, err);
    case RECORD_TEXTS: return read_texts(view, row, item, err);
    case RECORD_CHOICE: return read_word(view, row, at, &word, err);
    case RECORD_WORD: return read_word(view, row, &place, at, err);
    case RECORD_CONST: return read_const(view, row, err);
    case RECORD_FILE: return read_file(view, row, at, err);
    case RECORD_PATH:
        return read_text(view, row, &word, err) && json_view_file(view, row->key, word, at, err);
    case RECORD_REFER: return read_refer(view, row, at, err);
    case RECORD_OBJECT: return read_object(view, row, item, err);
    case RECORD_LIST:
    case RECORD_MAP: return read_items(view, row, item, err);
    default: return read_either(view, row, item, err);
    }
}

bool record_read_value(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    return (row->read ? row->read : record_read_kind)(view, row, item, err);
}

/* Refuses a key that no row has, with the nearest one. */
static bool check_keys(const JsonView *view, const char *format, const RecordRow *rows,
                       Error *err) {
    const char *known[KEYS_MAX], *key;
    json_t *value;
    int count = 0;
    for (const RecordRow *row = rows; row->key && count < KEYS_MAX; row++)
        known[count++] = row->key;
    json_object_foreach(view->object, key, value) {
        if (place_of(key, known, count) >= 0) continue;
        const char *instead = format ? removed_instead(format, key) : NULL;
        if (instead) return record_fails(view, key, err, "this key was removed: %s", instead);
        const char *meant = nearest_word_meant(key, known, count); /* "age" is "age_years" */
        return record_fails(view, key, err, "unknown key; the nearest known one is '%s'",
                            meant ? meant : nearest_word(key, known, count));
    }
    return true;
}

/* What nobody knows, of a row that says so by null. */
static void clear(const RecordRow *row, void *item) {
    void *at = at_offset(item, row->offset);
    if (row->kind == RECORD_TEXT) memset(at, 0, sizeof(const char *));
    if (row->kind == RECORD_CHOICE) memset(at, 0, sizeof(int));
    if (row->kind == RECORD_NUMBER) *(double *)at = (double)NAN;
    for (int i = 0; row->kind == RECORD_NUMBERS && i < row->most; i++)
        ((double *)at)[i] = (double)NAN;
    if (row->kind != RECORD_OBJECT) return;
    *(bool *)at_offset(item, row->count) = false;
    for (const RecordRow *inside = row->of->rows; inside->key; inside++)
        if (inside->flags & RECORD_NULL) clear(inside, at);
}

bool record_is_read(const RecordRow *row, bool is_kept) {
    if (row->flags & RECORD_KEPT) return is_kept;
    return !(row->flags & RECORD_WRITTEN) && !(is_kept && row->kind == RECORD_OWN);
}

bool record_read(const JsonView *outer, const RecordFormat *format, void *item, Error *err) {
    JsonView own = *outer, *view = &own;
    if (!own.whole) own.whole = item;
    if (!format->takes_more && !check_keys(view, format->name, format->rows, err)) return false;
    for (const RecordRow *row = format->rows; row->key; row++) {
        const json_t *value = json_object_get(view->object, row->key);
        if (!record_is_read(row, view->is_kept)) continue;
        if (!value && row->flags & RECORD_REQUIRED) return record_misses(view, row->key, err);
        if (row->flags & RECORD_NULL) clear(row, item);
        if (value && !(json_is_null(value) && row->flags & RECORD_NULL) &&
            !record_read_value(view, row, item, err))
            return false;
    }
    return !format->check || format->check(view, item, err);
}
