/* SPDX-License-Identifier: Apache-2.0 */
#include "record/record_schema.h"

#include <math.h>

static json_t *object_schema(const RecordFormat *format);

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

static json_t *number_schema(const RecordRow *row, const char *name)
{
    json_t *schema = kind(name);
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
    for (int i = 0; row->words[i]; i++) json_array_append_new(words, json_string(row->words[i]));
    return json_pack("{s:o}", "enum", words);
}

static json_t *list_schema(const RecordRow *row, json_t *items)
{
    json_t *schema = json_pack("{s:s, s:o}", "type", "array", "items", items);
    if (row->least) set(schema, "minItems", json_integer(row->least));
    if (row->most) set(schema, "maxItems", json_integer(row->most));
    return schema;
}

static json_t *value_schema(const RecordRow *row)
{
    switch (row->kind) {
    case RECORD_NUMBER: return number_schema(row, "number");
    case RECORD_INTEGER: return number_schema(row, "integer");
    case RECORD_NUMBERS:
    case RECORD_FIGURES: return list_schema(row, number_schema(row, "number"));
    case RECORD_FLAG: return kind("boolean");
    case RECORD_TEXT: return text_schema(row);
    case RECORD_TEXTS: return list_schema(row, kind("string"));
    case RECORD_CHOICE: return choice_schema(row);
    case RECORD_CONST:
        return json_pack("{s:o}", "const",
                         row->words ? json_string(row->words[0]) : number(row->low));
    case RECORD_OBJECT: return object_schema(row->of);
    case RECORD_LIST: return list_schema(row, object_schema(row->of));
    default: return loaded(row->schema);
    }
}

static json_t *object_schema(const RecordFormat *format)
{
    json_t *schema = kind("object"), *properties = json_object(), *required = json_array();
    for (const RecordRow *row = format->rows; row->key; row++) {
        json_t *value = value_schema(row);
        if (row->fallback) set(value, "default", loaded(row->fallback));
        if (row->doc) set(value, "description", json_string(row->doc));
        set(properties, row->key, value);
        if (row->flags & RECORD_REQUIRED)
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

json_t *record_schema(const RecordFormat *format, const char *title)
{
    json_t *schema = json_pack("{s:s, s:s}", "$schema",
                               "https://json-schema.org/draft/2020-12/schema", "title", title);
    json_t *body = object_schema(format);
    json_object_update(schema, body);
    json_decref(body);
    return schema;
}
