/* SPDX-License-Identifier: Apache-2.0 */
#include "record/record_write.h"

#include <math.h>
#include <string.h>

#include "text/base64.h"
#include "text/json_text.h"

#define FLOATS_BYTES ((size_t)1 << 34) /* address space: what is not touched costs nothing */

/* Of a document that is kept: what JSON has no value for is a text, or a list of bytes. */
static json_t *figure(double value, bool is_kept) {
    bool is_text = is_kept && isinf(value);
    return is_text ? json_string(value > 0 ? record_infinite : record_infinite_below)
                   : json_figure(value);
}

static json_t *text(const char *string, bool is_kept) {
    json_t *out = string && is_kept ? json_string(string) : json_text_or_null(string);
    if (out) return out;
    out = json_array();
    for (; *string; string++) json_array_append_new(out, json_integer((unsigned char)*string));
    return out;
}

static json_t *texts(const char *const *list, int count, bool is_kept) {
    json_t *out = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(out, text(list[i], is_kept));
    return out;
}

static json_t *word(const RecordRow *row, int place) {
    if (row->flags & RECORD_NULL) place--;
    return place < 0 ? json_null() : json_string(record_word(row, place));
}

static json_t *numbers(const RecordRow *row, const void *list, int count, bool is_kept) {
    json_t *out = json_array();
    for (int i = 0; i < count; i++) {
        bool is_float = row->flags & RECORD_FLOAT;
        double value = is_float ? (double)((const float *)list)[i] : ((const double *)list)[i];
        json_array_append_new(out, figure(value, is_kept));
    }
    return out;
}

static json_t *floats(const void *list, int count) {
    Arena room = arena_reserve(FLOATS_BYTES);
    Text digits = {.arena = &room};
    base64_encode(&digits, list, (size_t)count * sizeof(float));
    json_t *out = json_stringn(digits.size ? digits.data : "", digits.size);
    arena_release(&room);
    return out;
}

static json_t *object_json(const RecordFormat *format, const void *item, bool is_kept);

static json_t *list_json(const RecordFormat *format, const char *item, int count, bool is_kept) {
    json_t *list = json_array();
    for (int i = 0; i < count; i++, item += format->size)
        json_array_append_new(list, object_json(format, item, is_kept));
    return list;
}

static const char *pointer_at(const char *at) {
    const char *pointer;
    memcpy(&pointer, at, sizeof pointer);
    return pointer;
}

/* Pointers of any kind are copied as what they are to. */
static json_t *pointer_json(const RecordRow *row, const char *pointer, int count, bool is_kept) {
    const void *list = pointer;
    switch (row->kind) {
    case RECORD_FIGURES:
        return list || row->count ? numbers(row, list, count, is_kept) : json_null();
    case RECORD_FLOATS: return floats(list, count * row->most);
    case RECORD_TEXTS: return texts(list, count, is_kept);
    case RECORD_LIST: return list_json(row->of, pointer, count, is_kept);
    case RECORD_OBJECT: return pointer ? object_json(row->of, pointer, is_kept) : json_null();
    default: return text(pointer, is_kept);
    }
}

static json_t *kind_json(const RecordRow *row, const void *item, bool is_kept) {
    const char *at = (const char *)item + row->offset;
    const void *count = (const char *)item + row->count, *value = at;
    switch (row->kind) {
    case RECORD_NUMBER: return figure(*(const double *)value, is_kept);
    case RECORD_INTEGER:
        return json_integer(row->flags & RECORD_LONG ? *(const long *)value : *(const int *)value);
    case RECORD_NUMBERS: return numbers(row, value, row->most, is_kept);
    case RECORD_FLAG: return json_boolean(*(const bool *)value);
    case RECORD_CHOICE: return word(row, *(const int *)value);
    case RECORD_OBJECT:
        if (row->flags & RECORD_APART) break;
        if (row->flags & RECORD_NULL && row->count && !*(const bool *)count) return json_null();
        return object_json(row->of, at, is_kept);
    default: break;
    }
    return pointer_json(row, pointer_at(at), row->count ? *(const int *)count : row->most, is_kept);
}

static json_t *value_json(const RecordRow *row, const void *item, bool is_kept) {
    bool is_own = row->write && (!is_kept || row->flags & RECORD_KEPT);
    json_t *value = is_own ? row->write(item) : kind_json(row, item, is_kept);
    bool is_empty = !value || json_is_null(value) || json_is_false(value) ||
                    (json_is_array(value) && !json_array_size(value));
    if (!(row->flags & RECORD_BRIEF) || !is_empty) return value;
    json_decref(value);
    return NULL;
}

static bool is_written(const RecordRow *row, bool is_kept) {
    return is_kept ? record_is_read(row, true)
                   : !(row->flags & RECORD_KEPT) || row->flags & RECORD_WRITTEN;
}

static json_t *object_json(const RecordFormat *format, const void *item, bool is_kept) {
    json_t *object = json_object();
    for (const RecordRow *row = format->rows; row->key; row++) {
        json_t *value = is_written(row, is_kept) ? value_json(row, item, is_kept) : NULL;
        if (value) json_object_set_new(object, row->key, value);
    }
    return object;
}

json_t *record_write_value(const RecordRow *row, const void *item) {
    return value_json(row, item, false);
}

json_t *record_write(const RecordFormat *format, const void *item) {
    return object_json(format, item, false);
}

json_t *record_keep(const RecordFormat *format, const void *item) {
    return object_json(format, item, true);
}

json_t *record_write_list(const RecordFormat *format, const void *items, int count) {
    return list_json(format, items, count, false);
}
