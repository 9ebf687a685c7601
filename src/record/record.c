/* SPDX-License-Identifier: Apache-2.0 */
#include "record/record.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "text/nearest_word.h"

#define KEYS_MAX 256 /* of an object, and words of a choice */
#define LENGTH_LEAST 1e-9 /* shorter vectors have no direction */

bool record_fails(const JsonView *view, const char *key, Error *err, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    error_at_list(err, ERROR_INPUT, view->file, json_view_path(view, key), format, list);
    va_end(list);
    return false;
}

/* ---- single values ----------------------------------------------------------------------- */

static bool check_low(const JsonView *view, const RecordRow *row, double value, Error *err)
{
    return !(row->flags & RECORD_ABOVE) || value > row->low ||
           record_fails(view, row->key, err, "is %g, required: a number above %g", value,
                        row->low);
}

static bool read_number(const JsonView *view, const RecordRow *row, double *out, Error *err)
{
    double value = NAN, low = row->flags & RECORD_ABOVE ? -HUGE_VAL : row->low;
    if (!json_view_number(view, row->key, low, row->high, &value, err) ||
        !check_low(view, row, value, err))
        return false;
    if (row->flags & RECORD_WHOLE && value != floor(value))
        return record_fails(view, row->key, err, "is %g, required: a whole number", value);
    *out = row->flags & RECORD_RADIANS ? radians_from_degrees(value)
           : row->flags & RECORD_METRES ? value / 1000 : value;
    return true;
}

static bool read_integer(const JsonView *view, const RecordRow *row, int *out, Error *err)
{
    double    value;
    RecordRow whole = *row;
    whole.flags |= RECORD_WHOLE;
    if (!read_number(view, &whole, &value, err)) return false;
    *out = (int)value;
    return true;
}

static bool read_text(const JsonView *view, const RecordRow *row, const char **out, Error *err)
{
    if (!json_view_text(view, row->key, out, err)) return false;
    return !(row->flags & RECORD_FILLED) || **out ||
           record_fails(view, row->key, err, "is an empty text, required: some words");
}

const char *record_word(const RecordRow *row, int i)
{
    const char *word;
    size_t      stride = row->stride ? row->stride : sizeof *row->words;
    memcpy(&word, (const char *)row->words + (size_t)i * stride, sizeof word);
    return word;
}

/* The place of a word, and itself. */
static bool read_word(const JsonView *view, const RecordRow *row, int *place, const char **out,
                      Error *err)
{
    const char *text = NULL, *word, *known[KEYS_MAX];
    char        advice[256];
    int         count = 0;
    if (!json_view_text(view, row->key, &text, err)) return false;
    for (; count < KEYS_MAX && (word = record_word(row, count)); count++) {
        known[count] = word;
        if (strcmp(text, word) != 0) continue;
        *place = count;
        *out = word;
        return true;
    }
    return record_fails(view, row->key, err, "is '%.60s', required: another word: %s", text,
                        nearest_word_advice(text, known, count, advice, sizeof advice));
}

static bool read_const(const JsonView *view, const RecordRow *row, Error *err)
{
    const json_t *value = json_object_get(view->object, row->key);
    const char   *text = json_string_value(value);
    if (row->words ? !text : !json_is_number(value))
        return json_view_wrong_kind(view, row->key, value, row->words ? "a text" : "a number",
                                    err);
    if (row->words)
        return !strcmp(text, row->words[0]) ||
               record_fails(view, row->key, err, "is '%.60s', required: '%s'", text,
                            row->words[0]);
    return json_number_value(value) == row->low ||
           record_fails(view, row->key, err, "is %g, required: %g", json_number_value(value),
                        row->low);
}

/* ---- lists ------------------------------------------------------------------------------- */

static bool find_list(const JsonView *view, const RecordRow *row, const char *what, int *count,
                      Error *err)
{
    const json_t *list = json_object_get(view->object, row->key);
    if (!json_is_array(list)) return json_view_wrong_kind(view, row->key, list, what, err);
    size_t size = json_array_size(list), most = row->most ? (size_t)row->most : SIZE_MAX;
    if (size < (size_t)row->least || size > most) {
        if (row->least == row->most)
            return record_fails(view, row->key, err, "has %zu values, required: %d", size,
                                row->least);
        return record_fails(view, row->key, err,
                            row->most ? "has %zu values, required: %d to %d"
                                      : "has %zu values, required: at least %d", size,
                            row->least, row->most);
    }
    *count = (int)size;
    return true;
}

static void *at_offset(void *item, size_t offset)
{
    return (char *)item + offset;
}

static bool make_unit(const JsonView *view, const RecordRow *row, double *vector, Error *err)
{
    double length = hypot_d(hypot_d(vector[0], vector[1]), vector[2]);
    if (!(length > LENGTH_LEAST))
        return record_fails(view, row->key, err, "is the zero vector, required: a direction");
    for (int i = 0; i < 3; i++) vector[i] /= length;
    return true;
}

static bool check_numbers(const JsonView *view, const RecordRow *row, double *list, int count,
                          Error *err)
{
    bool is_whole = row->flags & RECORD_WHOLE || row->kind == RECORD_WHOLES;
    for (int i = 0; i < count; i++) {
        if (!check_low(view, row, list[i], err)) return false;
        if (is_whole && list[i] != floor(list[i]))
            return record_fails(view, row->key, err, "is %g, required: whole numbers", list[i]);
    }
    return !(row->flags & RECORD_UNIT) || make_unit(view, row, list, err);
}

static bool read_numbers(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    int count, found;
    if (!find_list(view, row, "an array of numbers", &count, err)) return false;
    void     *at = at_offset(item, row->offset);
    double   *list = row->kind == RECORD_NUMBERS ? at : ARENA_NEW(view->arena, double, count);
    JsonRange range = {row->flags & RECORD_ABOVE ? -HUGE_VAL : row->low, row->high, count};
    if ((count && !json_view_numbers(view, row->key, range, list, &found, err)) ||
        !check_numbers(view, row, list, count, err))
        return false;
    if (row->kind == RECORD_FIGURES) memcpy(at, &list, sizeof list);
    for (int i = 0; row->kind == RECORD_WHOLES && i < count; i++)
        ((int *)at)[i] = (int)list[i];
    if (row->count) *(int *)at_offset(item, row->count) = count;
    return true;
}

static bool read_texts(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    int count;
    if (!find_list(view, row, "an array of texts", &count, err)) return false;
    const char **texts = ARENA_NEW(view->arena, const char *, count);
    for (int i = 0; i < count; i++) {
        json_t *text = json_array_get(json_object_get(view->object, row->key), (size_t)i);
        if (!json_is_string(text))
            return json_view_wrong_kind(view, arena_format(view->arena, "%s/%d", row->key, i),
                                        text, "a text", err);
        texts[i] = arena_string(view->arena, json_string_value(text),
                                json_string_length(text));
    }
    memcpy(at_offset(item, row->offset), &texts, sizeof texts);
    *(int *)at_offset(item, row->count) = count;
    return true;
}

static bool read_list(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    int count;
    if (!find_list(view, row, "an array of objects", &count, err)) return false;
    char *items = arena_alloc(view->arena, row->of->size, _Alignof(max_align_t),
                              (size_t)count);
    for (int i = 0; i < count; i++) {
        JsonView    inside = *view;
        const char *place = arena_format(view->arena, "%s/%d", row->key, i);
        void       *at = items + (size_t)i * row->of->size;
        inside.object = json_array_get(json_object_get(view->object, row->key), (size_t)i);
        inside.path = json_view_path(view, place);
        if (!json_is_object(inside.object))
            return json_view_wrong_kind(view, place, inside.object, "an object", err);
        if (row->of->start) row->of->start(at);
        if (!record_read(&inside, row->of, at, err)) return false;
    }
    memcpy(at_offset(item, row->offset), &items, sizeof items);
    *(int *)at_offset(item, row->count) = count;
    return true;
}

/* ---- objects ----------------------------------------------------------------------------- */

static bool read_object(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    JsonView inside;
    if (!json_view_child(view, row->key, true, &inside, err) ||
        !record_read(&inside, row->of, at_offset(item, row->offset), err))
        return false;
    if (row->count) *(bool *)at_offset(item, row->count) = true;
    return true;
}

static bool read_flag(const JsonView *view, const RecordRow *row, bool *out, Error *err)
{
    const json_t *value = json_object_get(view->object, row->key);
    if (!json_is_boolean(value))
        return json_view_wrong_kind(view, row->key, value, "true or false", err);
    *out = json_is_true(value);
    return true;
}

bool record_read_value(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    void       *at = at_offset(item, row->offset);
    const char *word;
    int         place;
    switch (row->kind) {
    case RECORD_NUMBER: return read_number(view, row, at, err);
    case RECORD_INTEGER: return read_integer(view, row, at, err);
    case RECORD_NUMBERS:
    case RECORD_FIGURES:
    case RECORD_WHOLES: return read_numbers(view, row, item, err);
    case RECORD_FLAG: return read_flag(view, row, at, err);
    case RECORD_TEXT: return read_text(view, row, at, err);
    case RECORD_NOTE: return read_text(view, row, &word, err);
    case RECORD_TEXTS: return read_texts(view, row, item, err);
    case RECORD_CHOICE: return read_word(view, row, at, &word, err);
    case RECORD_WORD: return read_word(view, row, &place, at, err);
    case RECORD_CONST: return read_const(view, row, err);
    case RECORD_OBJECT: return read_object(view, row, item, err);
    case RECORD_LIST: return read_list(view, row, item, err);
    default: return row->read(view, row, item, err);
    }
}

bool record_read(const JsonView *view, const RecordFormat *format, void *item, Error *err)
{
    const char *keys[KEYS_MAX];
    int         count = 0;
    for (const RecordRow *row = format->rows; row->key && count < KEYS_MAX; row++)
        keys[count++] = row->key;
    if (!json_view_check_keys(view, keys, count, err)) return false;
    for (const RecordRow *row = format->rows; row->key; row++) {
        if (json_object_get(view->object, row->key)) {
            if (!record_read_value(view, row, item, err)) return false;
        } else if (row->flags & RECORD_REQUIRED) {
            return error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing",
                            row->key);
        }
    }
    return !format->check || format->check(view, item, err);
}
