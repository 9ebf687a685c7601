/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/tree.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

const GltfValue *tree_member(const GltfValue *object, const char *name) {
    if (!object || object->kind != GLTF_OBJECT) return NULL;
    for (int i = 0; i < object->count; i++)
        if (strcmp(object->items[i].key, name) == 0) return &object->items[i];
    return NULL;
}

const GltfValue *tree_item(const GltfValue *array, int index) {
    if (!array || array->kind != GLTF_ARRAY) return NULL;
    return index >= 0 && index < array->count ? &array->items[index] : NULL;
}

const GltfValue *tree_element(const GltfValue *root, const char *collection, int index) {
    return tree_item(tree_member(root, collection), index);
}

const GltfValue *tree_items(const GltfValue *object, const char *name) {
    const GltfValue *list = tree_member(object, name);
    return list && list->count ? list->items : NULL;
}

const GltfValue *tree_next(const GltfValue *item) {
    const GltfValue *list = item->parent;
    return item + 1 < list->items + list->count ? item + 1 : NULL;
}

const GltfValue *tree_referred(const GltfValue *index, const char *collection) {
    const GltfValue *root = index;
    while (root && root->parent) root = root->parent;
    return tree_element(root, collection, tree_whole(index, -1));
}

bool tree_lists(const GltfValue *array, const char *text) {
    for (int i = 0; array && array->kind == GLTF_ARRAY && i < array->count; i++)
        if (strcmp(array->items[i].text, text) == 0) return true;
    return false;
}

const GltfValue *tree_extension(const GltfValue *object, const char *name) {
    const GltfValue *own = tree_member(tree_member(object, "extensions"), name);
    if (own || strncmp(name, TREE_OURS, strlen(TREE_OURS)) != 0) return own;
    return tree_member(tree_member(object, "extras"), name);
}

int tree_count(const GltfValue *object, const char *name) {
    const GltfValue *value = tree_member(object, name);
    return value ? value->count : 0;
}

bool tree_is_integer(const GltfValue *value) {
    return value && value->kind == GLTF_NUMBER && value->number == floor(value->number) &&
           fabs(value->number) < 0x1p53;
}

double tree_number(const GltfValue *object, const char *name, double fallback) {
    const GltfValue *value = tree_member(object, name);
    return value && value->kind == GLTF_NUMBER ? value->number : fallback;
}

float tree_float(const GltfValue *object, const char *name, float fallback) {
    return (float)tree_number(object, name, (double)fallback);
}

int tree_whole(const GltfValue *value, int fallback) {
    if (!tree_is_integer(value) || fabs(value->number) > INT_MAX) return fallback;
    return (int)value->number;
}

int tree_int(const GltfValue *object, const char *name, int fallback) {
    return tree_whole(tree_member(object, name), fallback);
}

bool tree_boolean(const GltfValue *object, const char *name, bool fallback) {
    const GltfValue *value = tree_member(object, name);
    return value && value->kind == GLTF_BOOLEAN ? value->number != 0 : fallback;
}

const char *tree_text(const GltfValue *object, const char *name, const char *fallback) {
    const GltfValue *value = tree_member(object, name);
    return value && value->kind == GLTF_STRING ? value->text : fallback;
}

/* NULL unless it is so many numbers. */
static const GltfValue *numbers_of(const GltfValue *object, const char *name, int count) {
    const GltfValue *value = tree_member(object, name);
    if (!value || value->kind != GLTF_ARRAY || value->count != count) return NULL;
    for (int i = 0; i < count; i++)
        if (value->items[i].kind != GLTF_NUMBER) return NULL;
    return value;
}

bool tree_floats(const GltfValue *object, const char *name, int count, float *out) {
    const GltfValue *value = numbers_of(object, name, count);
    for (int i = 0; value && i < count; i++) out[i] = (float)value->items[i].number;
    return value != NULL;
}

bool tree_numbers(const GltfValue *object, const char *name, int count, double *out) {
    const GltfValue *value = numbers_of(object, name, count);
    for (int i = 0; value && i < count; i++) out[i] = value->items[i].number;
    return value != NULL;
}

/* Puts `text` in front of what already stands at *start. */
static void put_before(char *buffer, size_t *start, const char *text, size_t length) {
    if (length > *start) length = *start;
    *start -= length;
    memcpy(buffer + *start, text, length);
}

static void put_key_before(char *buffer, size_t *start, const char *key) {
    for (size_t i = strlen(key); i-- > 0;) {
        if (key[i] == '~') put_before(buffer, start, "~0", 2);
        else if (key[i] == '/') put_before(buffer, start, "~1", 2);
        else put_before(buffer, start, key + i, 1);
    }
}

void tree_pointer(const GltfValue *value, char *buffer, size_t size) {
    char text[1024]; /* filled from its end while walking up */
    size_t start = sizeof text;
    for (; value && value->parent; value = value->parent) {
        char number[16];
        snprintf(number, sizeof number, "%d", value->index);
        put_key_before(text, &start, value->key ? value->key : number);
        put_before(text, &start, "/", 1);
    }
    snprintf(buffer, size, "%.*s", (int)(sizeof text - start), text + start);
}
