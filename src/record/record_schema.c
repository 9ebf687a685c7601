/* SPDX-License-Identifier: Apache-2.0 */
#include "record/record_schema.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/units.h"

static json_t *object_schema(const RecordFormat *format, const void *item);
static json_t *object_schema_alone(const RecordFormat *format);

static void set(json_t *schema, const char *key, json_t *value)
{
    json_object_set_new(schema, key, value);
}

static json_t *kind(const char *name)
{
    return json_pack("{s:s}", "type", name);
}

static json_t *loaded(const char *text)
{
    return json_loads(text, JSON_DECODE_ANY, NULL);
}

/* 5 as 5, 0.5 as 0.5. */
static json_t *number(double value)
{
    return value == rint(value) && fabs(value) < 1e15 ? json_integer((json_int_t)value)
                                                      : json_real(value);
}

static json_t *number_schema(const RecordRow *row)
{
    bool    is_whole = row->kind == RECORD_INTEGER || row->kind == RECORD_WHOLES ||
                       row->flags & RECORD_WHOLE;
    json_t *schema = kind(is_whole ? "integer" : "number");
    if (isfinite(row->low))
        set(schema, row->flags & RECORD_ABOVE ? "exclusiveMinimum" : "minimum",
            number(row->low));
    if (isfinite(row->high)) set(schema, "maximum", number(row->high));
    return schema;
}

static json_t *text_schema(const RecordRow *row)
{
    json_t *schema = kind("string");
    if (row->flags & RECORD_FILLED) set(schema, "minLength", json_integer(1));
    return schema;
}

static json_t *choice_schema(const RecordRow *row)
{
    json_t *words = json_array();
    for (int i = 0; record_word(row, i); i++)
        json_array_append_new(words, json_string(record_word(row, i)));
    return json_pack("{s:o}", "enum", words);
}

static json_t *list_schema(const RecordRow *row, json_t *items)
{
    json_t *schema = json_pack("{s:s, s:o}", "type", "array", "items", items);
    if (row->flags & RECORD_UNIT)
        set(schema, "not", loaded("{\"items\": {\"const\": 0}}"));
    if (row->least) set(schema, "minItems", json_integer(row->least));
    if (row->most) set(schema, "maxItems", json_integer(row->most));
    return schema;
}

/* item: holds the defaults; NULL: nobody knows them. */
static json_t *value_schema(const RecordRow *row, const void *item)
{
    switch (row->kind) {
    case RECORD_NUMBER:
    case RECORD_INTEGER: return number_schema(row);
    case RECORD_NUMBERS:
    case RECORD_FIGURES:
    case RECORD_WHOLES: return list_schema(row, number_schema(row));
    case RECORD_FLAG: return kind("boolean");
    case RECORD_TEXT:
    case RECORD_NOTE: return text_schema(row);
    case RECORD_TEXTS: return list_schema(row, kind("string"));
    case RECORD_CHOICE:
    case RECORD_WORD: return choice_schema(row);
    case RECORD_CONST:
        return json_pack("{s:o}", "const",
                         row->words ? json_string(row->words[0]) : number(row->low));
    case RECORD_OBJECT:
        return object_schema(row->of, item ? (const char *)item + row->offset : NULL);
    case RECORD_LIST: return list_schema(row, object_schema_alone(row->of));
    default: return row->schema ? loaded(row->schema) : choice_schema(row);
    }
}

/* NULL: a default that no file could state. */
static json_t *numbers(const RecordRow *row, const double *list, int count)
{
    json_t *out = json_array();
    for (int i = 0; i < count; i++) {
        double value = row->flags & RECORD_RADIANS  ? degrees_from_radians(list[i])
                       : row->flags & RECORD_METRES ? 1000 * list[i]
                                                    : list[i];
        bool is_low = value < row->low && !(row->flags & RECORD_RADIANS);
        if (is_low || isnan(value)) {
            json_decref(out);
            return NULL;
        }
        json_array_append_new(out, number(rint(1e9 * value) / 1e9));
    }
    return out;
}

/* What an absent member means; NULL: nothing that JSON could say. */
static json_t *default_of(const RecordRow *row, const void *item)
{
    const void *at = (const char *)item + row->offset;
    const void *count = (const char *)item + row->count;
    const double *figures = row->kind == RECORD_FIGURES ? *(double *const *)at : at;
    const char   *word;
    json_t       *list;
    switch (row->kind) {
    case RECORD_NUMBER:
        list = numbers(row, at, 1);
        json_t *first = json_incref(json_array_get(list, 0));
        json_decref(list);
        return first;
    case RECORD_INTEGER: return json_integer(*(const int *)at);
    case RECORD_NUMBERS:
    case RECORD_FIGURES:
        if (!figures || (row->count && !*(const int *)count)) return NULL;
        return numbers(row, figures, row->count ? *(const int *)count : row->most);
    case RECORD_FLAG: return json_boolean(*(const bool *)at);
    case RECORD_CHOICE: return json_string(record_word(row, *(const int *)at));
    case RECORD_WORD:
        memcpy(&word, at, sizeof word);
        return word ? json_string(word) : NULL;
    default: return NULL;
    }
}

static json_t *object_schema(const RecordFormat *format, const void *item)
{
    json_t *schema = kind("object"), *properties = json_object(), *required = json_array();
    for (const RecordRow *row = format->rows; row->key; row++) {
        json_t *value = value_schema(row, item);
        bool    is_required = row->flags & RECORD_REQUIRED;
        json_t *usual = is_required || !item ? NULL : default_of(row, item);
        if (usual) set(value, "default", usual);
        if (row->doc) set(value, "description", json_string(row->doc));
        set(properties, row->key, value);
        if (is_required)
            json_array_append_new(required, json_string(row->key));
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
static json_t *object_schema_alone(const RecordFormat *format)
{
    void   *item = calloc(1, format->size);
    if (item && format->start) format->start(item);
    json_t *schema = object_schema(format, item);
    free(item);
    return schema;
}

json_t *record_schema(const RecordFormat *format, const char *title)
{
    json_t *schema = json_pack("{s:s, s:s}", "$schema",
                               "https://json-schema.org/draft/2020-12/schema", "title", title);
    json_t *body = object_schema_alone(format);
    json_object_update(schema, body);
    json_decref(body);
    return schema;
}
