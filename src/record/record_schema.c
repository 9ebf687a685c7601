/* SPDX-License-Identifier: Apache-2.0 */
#include "record/record_schema.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/units.h"

static json_t *object_schema(const RecordFormat *format, const void *item);
static json_t *item_schema(const RecordFormat *format);
static json_t *value_schema(const RecordRow *row, const void *item);

static void set(json_t *schema, const char *key, json_t *value) {
    json_object_set_new(schema, key, value);
}

static json_t *kind(const char *name) {
    return json_pack("{s:s}", "type", name);
}

/* JSON of rows, in which ' stands for ". */
static json_t *loaded(const char *text) {
    char *copy = strdup(text);
    for (char *c = copy; c && *c; c++)
        if (*c == '\'') *c = '"';
    json_t *value = copy ? json_loads(copy, JSON_DECODE_ANY, NULL) : NULL;
    free(copy);
    return value;
}

/* 5 as 5, 0.5 as 0.5. */
static json_t *number(double value) {
    return value == rint(value) && fabs(value) < 1e15 ? json_integer((json_int_t)value)
                                                      : json_real(value);
}

static json_t *number_schema(const RecordRow *row) {
    bool is_whole =
        row->kind == RECORD_INTEGER || row->kind == RECORD_WHOLES || row->flags & RECORD_WHOLE;
    json_t *schema = kind(is_whole ? "integer" : "number");
    if (isfinite(row->low))
        set(schema, row->flags & RECORD_ABOVE ? "exclusiveMinimum" : "minimum", number(row->low));
    if (isfinite(row->high)) set(schema, "maximum", number(row->high));
    return schema;
}

static json_t *text_schema(const RecordRow *row) {
    json_t *schema = kind("string");
    if (row->flags & RECORD_FILLED) set(schema, "minLength", json_integer(1));
    return schema;
}

static json_t *choice_schema(const RecordRow *row) {
    json_t *words = json_array();
    for (int i = 0; record_word(row, i); i++)
        json_array_append_new(words, json_string(record_word(row, i)));
    return json_pack("{s:o}", "enum", words);
}

static json_t *list_schema(const RecordRow *row, json_t *items) {
    json_t *schema = json_pack("{s:s, s:o}", "type", "array", "items", items);
    if (row->flags & RECORD_UNIT) set(schema, "not", loaded("{'items': {'const': 0}}"));
    if (row->least) set(schema, "minItems", json_integer(row->least));
    if (row->most) set(schema, "maxItems", json_integer(row->most));
    return schema;
}

static json_t *file_schema(void) {
    return json_pack("{s:s, s:i, s:s}", "type", "string", "minLength", 1, "format",
                     "uri-reference");
}

static json_t *map_schema(const RecordRow *row) {
    json_t *schema = json_pack("{s:s, s:o, s:{s:i}}", "type", "object", "additionalProperties",
                               item_schema(row->of), "propertyNames", "minLength", 1);
    if (row->least) set(schema, "minProperties", json_integer(row->least));
    if (row->most) set(schema, "maxProperties", json_integer(row->most));
    return schema;
}

static json_t *either_schema(const RecordRow *row) {
    json_t *forms = json_array();
    for (const RecordRow *form = row->forms; form->key; form++) {
        json_t *one = value_schema(form, NULL);
        set(one, "description", json_string(form->doc ? form->doc : form->key));
        json_array_append_new(forms, one);
    }
    return json_pack("{s:o}", "anyOf", forms);
}

/* item: holds the defaults; NULL: nobody knows them. */
static json_t *value_schema(const RecordRow *row, const void *item) {
    switch (row->kind) {
    case RECORD_NUMBER:
    case RECORD_INTEGER: return number_schema(row);
    case RECORD_WHOLES:
    case RECORD_NUMBERS:
    case RECORD_FIGURES: return list_schema(row, number_schema(row));
    case RECORD_FLAG: return kind("boolean");
    case RECORD_TEXT:
    case RECORD_NOTE:
    case RECORD_PATH: return text_schema(row);
    case RECORD_TEXTS: return list_schema(row, kind("string"));
    case RECORD_CHOICE:
    case RECORD_WORD: return choice_schema(row);
    case RECORD_CONST:
        return json_pack("{s:o}", "const",
                         row->words ? json_string(row->words[0]) : number(row->low));
    case RECORD_FILE: return file_schema();
    case RECORD_REFER: return kind("string");
    case RECORD_OBJECT:
        if (row->flags & RECORD_APART) return item_schema(row->of);
        return object_schema(row->of, item ? (const char *)item + row->offset : NULL);
    case RECORD_LIST: return list_schema(row, item_schema(row->of));
    case RECORD_MAP: return map_schema(row);
    case RECORD_EITHER: return either_schema(row);
    default:
        if (row->schema) return loaded(row->schema);
        return row->of ? item_schema(row->of) : choice_schema(row);
    }
}

/* The i-th of a row's. */
static double number_at(const RecordRow *row, const void *at, int i) {
    if (row->kind == RECORD_INTEGER || row->kind == RECORD_WHOLES) return ((const int *)at)[i];
    double value =
        row->flags & RECORD_FLOAT ? (double)((const float *)at)[i] : ((const double *)at)[i];
    if (row->flags & RECORD_METRES) return 1000 * value;
    return row->flags & RECORD_RADIANS ? degrees_from_radians(value) : value;
}

/* NULL: a default that no file could state. */
static json_t *numbers(const RecordRow *row, const void *list, int count) {
    json_t *out = json_array();
    bool is_zero = row->flags & RECORD_UNIT;
    for (int i = 0; i < count; i++) {
        double value = number_at(row, list, i);
        is_zero = is_zero && value == 0;
        if ((value < row->low && !(row->flags & RECORD_RADIANS)) || isnan(value)) {
            json_decref(out);
            return NULL;
        }
        json_array_append_new(out, number(rint(1e9 * value) / 1e9));
    }
    if (!is_zero) return out;
    json_decref(out);
    return NULL;
}

/* What an absent member means; NULL: nothing that JSON could say. */
static json_t *default_of(const RecordRow *row, const void *item) {
    const void *at = (const char *)item + row->offset;
    const void *count = (const char *)item + row->count;
    const void *list = row->kind == RECORD_FIGURES ? *(double *const *)at : at;
    const char *word;
    switch (row->kind) {
    case RECORD_NUMBER:
    case RECORD_INTEGER: {
        json_t *one = numbers(row, at, 1), *first = json_incref(json_array_get(one, 0));
        json_decref(one);
        return first;
    }
    case RECORD_WHOLES:
    case RECORD_NUMBERS:
    case RECORD_FIGURES:
        if (!list || (row->count && !*(const int *)count)) return NULL;
        return numbers(row, list, row->count ? *(const int *)count : row->most);
    case RECORD_FLAG: return json_boolean(*(const bool *)at);
    case RECORD_CHOICE: return json_string(record_word(row, *(const int *)at));
    case RECORD_WORD: memcpy(&word, at, sizeof word); return word ? json_string(word) : NULL;
    default: return NULL;
    }
}

static json_t *object_schema(const RecordFormat *format, const void *item) {
    json_t *schema = kind("object"), *properties = json_object(), *required = json_array();
    for (const RecordRow *row = format->rows; row->key; row++) {
        json_t *value = value_schema(row, item);
        bool is_required = row->flags & RECORD_REQUIRED;
        bool is_open = is_required || row->read || row->flags & RECORD_OPEN;
        json_t *usual = is_open || !item ? NULL : default_of(row, item);
        if (usual) set(value, "default", usual);
        if (row->doc) set(value, "description", json_string(row->doc));
        set(properties, row->key, value);
        if (is_required) json_array_append_new(required, json_string(row->key));
    }
    if (format->doc) set(schema, "description", json_string(format->doc));
    set(schema, "properties", properties);
    set(schema, "required", required);
    set(schema, "additionalProperties", json_false());
    if (format->rules) {
        json_t *rules = loaded(format->rules);
        json_object_update(schema, rules);
        json_decref(rules);
    }
    return schema;
}

/* Of a list's item, or a whole file. */
static json_t *item_schema(const RecordFormat *format) {
    void *item = calloc(1, format->size);
    if (item && format->start) format->start(item);
    json_t *schema =
        format->value ? value_schema(format->value, NULL) : object_schema(format, item);
    if (format->value && format->value->doc)
        set(schema, "description", json_string(format->value->doc));
    free(item);
    return schema;
}

json_t *record_schema(const RecordFormat *format, const char *title) {
    json_t *schema = json_pack("{s:s, s:s}", "$schema",
                               "https://json-schema.org/draft/2020-12/schema", "title", title);
    json_t *body = item_schema(format);
    json_object_update(schema, body);
    json_decref(body);
    return schema;
}
