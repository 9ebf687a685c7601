/* SPDX-License-Identifier: Apache-2.0 */
#include "record/record_write.h"

#include <string.h>

#include "text/json_text.h"

static json_t *text(const char *string) {
    return string ? json_text(string) : json_null();
}

static json_t *word(const RecordRow *row, int place) {
    if (row->flags & RECORD_NULL) place--;
    return place < 0 ? json_null() : json_string(record_word(row, place));
}

static json_t *numbers(const double *list, int count) {
    json_t *out = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(out, json_figure(list[i]));
    return out;
}

static json_t *apart_json(const RecordRow *row, const char *at) {
    const void *apart;
    memcpy(&apart, at, sizeof apart);
    return apart ? record_write(row->of, apart) : json_null();
}

/* Pointers of any kind are copied as what they are to. */
static json_t *kind_json(const RecordRow *row, const void *item) {
    const char *at = (const char *)item + row->offset, *pointer;
    const void *count = (const char *)item + row->count, *value = at;
    bool is_absent = row->flags & RECORD_NULL && row->count && !*(const bool *)count;
    switch (row->kind) {
    case RECORD_NUMBER: return json_figure(*(const double *)value);
    case RECORD_INTEGER:
        return json_integer(row->flags & RECORD_LONG ? *(const long *)value : *(const int *)value);
    case RECORD_NUMBERS: return numbers(value, row->most);
    case RECORD_FLAG: return json_boolean(*(const bool *)value);
    case RECORD_CHOICE: return word(row, *(const int *)value);
    case RECORD_OBJECT:
        if (row->flags & RECORD_APART) return apart_json(row, at);
        return is_absent ? json_null() : record_write(row->of, at);
    default:
        memcpy(&pointer, at, sizeof pointer);
        if (row->kind == RECORD_TEXTS)
            return json_texts((const char *const *)(const void *)pointer, *(const int *)count);
        return row->kind == RECORD_LIST ? record_write_list(row->of, pointer, *(const int *)count)
                                        : text(pointer);
    }
}

json_t *record_write_value(const RecordRow *row, const void *item) {
    json_t *value = row->write ? row->write(item) : kind_json(row, item);
    bool is_empty = !value || json_is_null(value) || json_is_false(value) ||
                    (json_is_array(value) && !json_array_size(value));
    if (!(row->flags & RECORD_BRIEF) || !is_empty) return value;
    json_decref(value);
    return NULL;
}

json_t *record_write(const RecordFormat *format, const void *item) {
    json_t *object = json_object();
    for (const RecordRow *row = format->rows; row->key; row++) {
        json_t *value = record_write_value(row, item);
        if (value) json_object_set_new(object, row->key, value);
    }
    return object;
}

json_t *record_write_list(const RecordFormat *format, const void *items, int count) {
    json_t *list = json_array();
    const char *item = items;
    for (int i = 0; i < count; i++, item += format->size)
        json_array_append_new(list, record_write(format, item));
    return list;
}
