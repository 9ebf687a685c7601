/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/schema.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "scene/check/our_extensions.h"
#include "scene/check/schema_extensions.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "scene/gltf/extras.h"
#include "text/nearest_word.h"
#include "text/removed.h"

#define MEMBERS_MAX 64 /* of one object that are compared with an unknown one */

static bool is_component_type(const char *key) {
    return key && strcmp(key, "componentType") == 0;
}

/* The value found, for "is ..., ... is required". */
static const char *describe(const GltfValue *value, char *buffer, size_t size) {
    switch (value->kind) {
    case GLTF_NULL: return "null";
    case GLTF_BOOLEAN: return value->number != 0 ? "true" : "false";
    case GLTF_NUMBER:
        if (is_component_type(value->key) && tree_is_integer(value) && value->number >= 5120 &&
            value->number <= 5126)
            return component_name((int)value->number);
        snprintf(buffer, size, "%.16g", value->number);
        return buffer;
    case GLTF_STRING: snprintf(buffer, size, "\"%.80s\"", value->text); return buffer;
    case GLTF_ARRAY: snprintf(buffer, size, "an array of %d", value->count); return buffer;
    case GLTF_OBJECT: return "an object";
    }
    return "";
}

static void fails_as(const DocumentCheck *check, const GltfValue *value, const char *wanted) {
    char found[128];
    check_fails(check, value, "is %s, %s is required", describe(value, found, sizeof found),
                wanted);
}

/* ---- single values --------------------------------------------------------------------- */

static bool has_max(const Rule *rule) {
    return rule->max > rule->min;
}

/* A scene's numbers are kept as floats. */
static bool is_too_large(const Rule *rule, double number) {
    return fabs(number) > (double)FLT_MAX && !(rule->flags & RULE_ANY_SIZE);
}

static bool in_range(const Rule *rule, double number) {
    if (is_too_large(rule, number)) return false;
    if (!has_max(rule) && !(rule->flags & RULE_FROM_MIN)) return true;
    if (rule->flags & RULE_ABOVE_MIN ? !(number > rule->min) : !(number >= rule->min)) return false;
    return !has_max(rule) || number <= rule->max;
}

static void check_number(const DocumentCheck *check, const GltfValue *value, const Rule *rule) {
    bool is_integer = rule->kind == RULE_INTEGER;
    bool is_kind = is_integer ? tree_is_integer(value) : value->kind == GLTF_NUMBER;
    const char *noun = is_integer ? "an integer" : "a number";
    char wanted[128];
    if (is_kind && in_range(rule, value->number)) return;
    if (is_kind && is_too_large(rule, value->number) && !has_max(rule))
        snprintf(wanted, sizeof wanted, "%s within 3.4e38, as far as floats go,", noun);
    else if (rule->flags & RULE_FROM_MIN)
        snprintf(wanted, sizeof wanted, "%s %s %.16g", noun,
                 rule->flags & RULE_ABOVE_MIN ? "above" : "of at least", rule->min);
    else if (!has_max(rule)) snprintf(wanted, sizeof wanted, "%s", noun);
    else
        snprintf(wanted, sizeof wanted, "%s %s %.16g %s %.16g", noun,
                 rule->flags & RULE_ABOVE_MIN ? "above" : "from", rule->min,
                 rule->flags & RULE_ABOVE_MIN ? "and up to" : "to", rule->max);
    fails_as(check, value, wanted);
}

/* Whether `text` is one of the words of "a|b|c", or of a list. */
static bool is_among(const Rule *rule, const char *text) {
    const char *words = rule->of ? rule->of : "";
    for (int i = 0; rule->words && rule->words[i]; i++)
        if (strcmp(rule->words[i], text) == 0) return true;
    size_t length = strlen(text);
    for (const char *word = words; *word;) {
        size_t size = strcspn(word, "|");
        if (size == length && strncmp(word, text, size) == 0) return true;
        word += size + (word[size] == '|');
    }
    return false;
}

/* "a|b|c"; component types by their names as well. */
static void list_choices(const Rule *rule, char *out, size_t size) {
    size_t used = (size_t)snprintf(out, size, "one of ");
    for (int i = 0; rule->words && rule->words[i]; i++)
        used += (size_t)snprintf(out + used, size - used, "%s%s", i ? "|" : "", rule->words[i]);
    if (rule->words) return;
    if (!is_component_type(rule->name)) {
        snprintf(out + used, size - used, "%s", rule->of);
        return;
    }
    for (const char *word = rule->of; *word; word += 4 + (word[4] == '|')) {
        uint64_t code = 0;
        number_read_count(word, &code);
        used += (size_t)snprintf(out + used, size - used, "%s%s", word == rule->of ? "" : "|",
                                 component_name((int)code));
    }
}

static void check_choice(const DocumentCheck *check, const GltfValue *value, const Rule *rule) {
    char text[32], wanted[160];
    bool is_code = rule->kind == RULE_CODE;
    if (is_code && tree_is_integer(value)) {
        snprintf(text, sizeof text, "%.0f", value->number);
        if (is_among(rule, text)) return;
    }
    if (!is_code && value->kind == GLTF_STRING && is_among(rule, value->text)) return;
    list_choices(rule, wanted, sizeof wanted);
    DocumentCheck milder = *check;
    bool is_kind = is_code ? tree_is_integer(value) : value->kind == GLTF_STRING;
    if (is_kind && !(rule->flags & RULE_CLOSED)) milder.severity = SEVERITY_WARNING;
    fails_as(&milder, value, wanted);
}

/* The list a rule refers to: "nodes", or "extensions/NAME/list" below the document. */
static const GltfValue *referred_list(const GltfFile *file, const char *path) {
    const GltfValue *value = file->root;
    while (value && *path) {
        char name[64];
        size_t size = strcspn(path, "/");
        snprintf(name, sizeof name, "%.*s", (int)size, path);
        value = tree_member(value, name);
        path += size + (path[size] == '/');
    }
    return value && value->kind == GLTF_ARRAY ? value : NULL;
}

static void check_index(const DocumentCheck *check, const GltfValue *value, const char *of) {
    const GltfValue *list = referred_list(check->file, of);
    const char *slash = strrchr(of, '/'), *noun = slash ? slash + 1 : of;
    int count = list ? list->count : 0;
    char wanted[96];
    if (tree_is_integer(value) && value->number >= 0 && value->number < count) return;
    if (tree_is_integer(value) && value->number >= 0)
        check_fails(check, value, "is %.0f, but there %s %d in %s", value->number,
                    count == 1 ? "is" : "are", count, noun);
    else {
        snprintf(wanted, sizeof wanted, "an index into %s", noun);
        fails_as(check, value, wanted);
    }
}

/* ---- arrays ---------------------------------------------------------------------------- */

static bool check_array(const DocumentCheck *check, const GltfValue *value, const Rule *rule) {
    char wanted[96];
    if (value->kind != GLTF_ARRAY) {
        fails_as(check, value, "an array");
        return false;
    }
    bool is_short = value->count < rule->least, is_long = rule->most && value->count > rule->most;
    if (is_short || is_long) {
        if (rule->least == rule->most)
            snprintf(wanted, sizeof wanted, "an array of %d", rule->least);
        else snprintf(wanted, sizeof wanted, "an array of %d to %d", rule->least, rule->most);
        fails_as(check, value, wanted);
    }
    return true;
}

static void check_value(const DocumentCheck *check, const GltfValue *value, const Rule *rule);

static void check_items(const DocumentCheck *check, const GltfValue *array, const Rule *rule) {
    static const RuleKind ITEM[] = {[RULE_INDICES] = RULE_INDEX,
                                    [RULE_NUMBERS] = RULE_NUMBER,
                                    [RULE_TEXTS] = RULE_TEXT,
                                    [RULE_OBJECTS] = RULE_OBJECT};
    Rule item = *rule;
    if (!check_array(check, array, rule)) return;
    item.kind = ITEM[rule->kind];
    for (int i = 0; i < array->count; i++) check_value(check, &array->items[i], &item);
}

static void check_map(const DocumentCheck *check, const GltfValue *value, const Rule *rule) {
    if (value->kind != GLTF_OBJECT) {
        fails_as(check, value, "an object");
        return;
    }
    for (int i = 0; i < value->count; i++) check_index(check, &value->items[i], rule->of);
}

static void check_value(const DocumentCheck *check, const GltfValue *value, const Rule *rule) {
    DocumentCheck inner = *check;
    bool is_at_rest = !check->file->load->options->state.has_time;
    if (rule->flags & RULE_WARNS || (rule->flags & RULE_WARNS_AT_REST && is_at_rest))
        inner.severity = SEVERITY_WARNING;
    switch (rule->kind) {
    case RULE_NUMBER:
    case RULE_INTEGER: check_number(&inner, value, rule); break;
    case RULE_BOOLEAN:
        if (value->kind != GLTF_BOOLEAN) fails_as(&inner, value, "true or false");
        break;
    case RULE_TEXT:
        if (value->kind != GLTF_STRING) fails_as(&inner, value, "a text");
        break;
    case RULE_CHOICE:
    case RULE_CODE: check_choice(&inner, value, rule); break;
    case RULE_INDEX: check_index(&inner, value, rule->of); break;
    case RULE_OBJECT: schema_check(&inner, value, rule->schema); break;
    case RULE_MAP: check_map(&inner, value, rule); break;
    case RULE_INDICES:
    case RULE_NUMBERS:
    case RULE_TEXTS:
    case RULE_OBJECTS: check_items(&inner, value, rule); break;
    case RULE_ANY: break;
    }
}

/* ---- objects --------------------------------------------------------------------------- */

static int names_of(const Schema *schema, const char *names[MEMBERS_MAX]) {
    int count = 0;
    for (const Rule *rule = schema->rules; rule->name && count < MEMBERS_MAX; rule++)
        names[count++] = rule->name;
    return count;
}

static const Rule *find_rule(const Schema *schema, const char *name) {
    for (const Rule *rule = schema->rules; rule->name; rule++)
        if (strcmp(rule->name, name) == 0) return rule;
    return NULL;
}

static void check_unknown(const DocumentCheck *check, const GltfValue *member,
                          const Schema *schema) {
    const char *names[MEMBERS_MAX];
    int count = names_of(schema, names);
    const char *near = nearest_key(member->key, names, count, 3);
    char hint[100] = "";
    if (schema->is_ours) {
        const char *instead = removed_instead(schema->name, member->key);
        if (instead) {
            check_fails(check, member, "this key was removed: %s", instead);
            return;
        }
        if (!near) near = nearest_word_meant(member->key, names, count);
        check_fails(check, member, "unknown key; the nearest known one is '%s'",
                    near ? near : nearest_word(member->key, names, count));
        return;
    }
    if (near) snprintf(hint, sizeof hint, "; is \"%s\" meant?", near);
    check_warns(check, member, "is no member of glTF's %s and is skipped%s", schema->name, hint);
}

static void check_extension(const DocumentCheck *check, const GltfValue *extension,
                            const char *host) {
    bool is_known = false;
    DocumentCheck inner = *check;
    const ExtensionRule *rule = extension_rule(extension->key, host, &is_known);
    if (extension->kind != GLTF_OBJECT) {
        fails_as(check, extension, "an object");
        return;
    }
    if (!rule && is_known)
        check_warns(check, extension, "%s has no meaning on a %s and is skipped", extension->key,
                    host);
    if (!extension_is_supported(extension->key)) inner.severity = SEVERITY_WARNING;
    if (rule && rule->schema) schema_check(&inner, extension, rule->schema);
}

/* Checks only those extras that are named as our extensions are; others may be there. */
static void check_extras(const DocumentCheck *check, const GltfValue *extras, const char *host) {
    const GltfValue *extensions = tree_member(extras->parent, "extensions");
    for (int i = 0; extras->kind == GLTF_OBJECT && i < extras->count; i++) {
        bool is_known = false;
        const GltfValue *member = &extras->items[i];
        if (!extras_is_ours(member)) continue;
        if (extension_rule(member->key, host, &is_known) == NULL)
            check_warns(check, member,
                        is_known ? "has no meaning on a %s and is skipped"
                                 : "names no extension for a %s and is skipped",
                        host);
        else if (tree_member(extensions, member->key))
            check_fails(check, member, "stands in extras and in extensions; one is required");
        else check_extension(check, member, host);
    }
}

static void check_common(const DocumentCheck *check, const GltfValue *member,
                         const Schema *schema) {
    if (strcmp(member->key, "extras") == 0) {
        check_extras(check, member, schema->name);
        return;
    }
    if (strcmp(member->key, "name") == 0) {
        if (member->kind != GLTF_STRING) fails_as(check, member, "a text");
        return;
    }
    if (strcmp(member->key, "extensions") != 0) {
        check_unknown(check, member, schema);
        return;
    }
    if (member->kind != GLTF_OBJECT) fails_as(check, member, "an object");
    for (int i = 0; member->kind == GLTF_OBJECT && i < member->count; i++) {
        const GltfValue *extension = &member->items[i];
        if (!document_uses(check->file, extension->key))
            check_warns(check, extension, "%s is used but not listed in extensionsUsed",
                        extension->key);
        check_extension(check, extension, schema->name);
    }
}

/* ---- rows as rules ---------------------------------------------------------------------- */

static Rule rule_of(const RecordRow *row) {
    static const RuleKind KINDS[] = {
        [RECORD_NUMBER] = RULE_NUMBER,   [RECORD_INTEGER] = RULE_INTEGER,
        [RECORD_NUMBERS] = RULE_NUMBERS, [RECORD_FLAG] = RULE_BOOLEAN,
        [RECORD_TEXT] = RULE_TEXT,       [RECORD_FILE] = RULE_TEXT,
        [RECORD_CHOICE] = RULE_CHOICE,   [RECORD_OBJECT] = RULE_OBJECT,
        [RECORD_LIST] = RULE_OBJECTS,    [RECORD_EITHER] = RULE_ANY};
    Rule rule = {.name = row->key,
                 .kind = KINDS[row->kind],
                 .flags = RULE_CLOSED,
                 .least = row->least,
                 .most = row->most,
                 .words = row->words,
                 .schema = row->of ? our_schema(row->of) : NULL};
    if (row->flags & RECORD_REQUIRED) rule.flags |= RULE_REQUIRED;
    if (row->flags & RECORD_ABOVE) rule.flags |= RULE_ABOVE_MIN;
    if (isfinite(row->low)) rule.min = row->low;
    if (isfinite(row->high)) rule.max = row->high;
    else if (isfinite(row->low)) rule.flags |= RULE_FROM_MIN;
    return rule;
}

/* But for what every object of glTF may have. */
static Schema with_rules(const Schema *schema, Rule rules[MEMBERS_MAX]) {
    Schema own = *schema;
    int count = 0;
    if (!schema->format) return own;
    for (const RecordRow *row = schema->format->rows; row->key; row++)
        if (row->kind != RECORD_OWN && count + 1 < MEMBERS_MAX) rules[count++] = rule_of(row);
    rules[count].name = NULL;
    own.rules = rules;
    return own;
}

void schema_check(const DocumentCheck *check, const GltfValue *value, const Schema *described) {
    Rule rules[MEMBERS_MAX];
    const Schema own = with_rules(described, rules), *schema = &own;
    if (value->kind != GLTF_OBJECT) {
        fails_as(check, value, "an object");
        return;
    }
    for (const Rule *rule = schema->rules; rule->name; rule++)
        if (rule->flags & RULE_REQUIRED && !tree_member(value, rule->name))
            check_fails(check, value, "\"%s\" is missing", rule->name);
    for (int i = 0; i < value->count; i++) {
        const GltfValue *member = &value->items[i];
        const Rule *rule = find_rule(schema, member->key);
        if (rule && rule->needs && !tree_member(value, rule->needs))
            check_warns(check, member, "stands there without \"%s\", which it needs", rule->needs);
        if (rule) check_value(check, member, rule);
        else check_common(check, member, schema);
    }
    if (schema->more) schema->more(check, value);
}
