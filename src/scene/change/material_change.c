/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/change/material_change.h"

#include <string.h>

#include "scene/gltf/document.h"

/* ---- values ------------------------------------------------------------------------------ */

/* The value's items know it, and their own know them, wherever all of them were before. */
static void adopt(GltfValue *value) {
    GltfValue *items = (GltfValue *)value->items;
    for (int i = 0; i < value->count; i++) {
        items[i].parent = value;
        items[i].index = i;
        for (int k = 0; k < items[i].count; k++)
            ((GltfValue *)&items[i].items[k])->parent = &items[i];
    }
}

/* Takes the content of another; keeps its own place. */
static void take(GltfValue *value, const GltfValue *from) {
    value->kind = from->kind;
    value->number = from->number;
    value->text = from->text;
    value->items = from->items;
    value->count = from->count;
    adopt(value);
}

/* Makes room for more items; the value becomes an array or object with what it had. */
static GltfValue *with_room(GltfValue *value, int more, Arena *arena) {
    GltfValue *items = ARENA_NEW(arena, GltfValue, value->count + more);
    if (value->count) memcpy(items, value->items, (size_t)value->count * sizeof *items);
    value->items = items;
    return items;
}

static int place_of(const GltfValue *object, const char *key) {
    for (int i = 0; i < object->count; i++)
        if (!strcmp(object->items[i].key, key)) return i;
    return NO_ID;
}

static void remove_item(GltfValue *object, int place) {
    GltfValue *items = (GltfValue *)object->items;
    int after = object->count - place - 1;
    memmove(items + place, items + place + 1, (size_t)after * sizeof *items);
    object->count--;
}

/* ---- merging ----------------------------------------------------------------------------- */

static void merge(GltfValue *into, const GltfValue *patch, Arena *arena);

static void merge_member(GltfValue *into, const GltfValue *member, Arena *arena) {
    GltfValue *items = (GltfValue *)into->items; /* there is room for one more */
    int place = place_of(into, member->key);
    if (member->kind == GLTF_NULL) {
        if (place != NO_ID) remove_item(into, place);
        return;
    }
    if (place == NO_ID) {
        place = into->count++;
        items[place] = (GltfValue){.key = member->key, .kind = GLTF_NULL, .text = ""};
    }
    merge(&items[place], member, arena);
}

static void merge(GltfValue *into, const GltfValue *patch, Arena *arena) {
    if (patch->kind != GLTF_OBJECT) {
        take(into, patch);
        return;
    }
    if (into->kind != GLTF_OBJECT) take(into, &(GltfValue){.kind = GLTF_OBJECT, .text = ""});
    with_room(into, patch->count, arena);
    for (int i = 0; i < patch->count; i++) merge_member(into, &patch->items[i], arena);
    adopt(into);
}

/* ---- extensionsUsed ---------------------------------------------------------------------- */

static GltfValue *list_of_used(GltfFile *file, Arena *arena) {
    GltfValue *root = (GltfValue *)file->root;
    int place = place_of(root, "extensionsUsed");
    if (place != NO_ID) return (GltfValue *)&root->items[place];
    GltfValue *items = with_room(root, 1, arena);
    place = root->count++;
    items[place] = (GltfValue){.key = "extensionsUsed", .kind = GLTF_ARRAY, .text = ""};
    adopt(root);
    return &items[place];
}

static void add_used(GltfFile *file, const GltfValue *patch) {
    Arena *arena = &file->load->scratch;
    const GltfValue *added = tree_member(patch, "extensions");
    for (int i = 0; added && i < added->count; i++) {
        const char *name = added->items[i].key;
        if (added->items[i].kind == GLTF_NULL || document_uses(file, name)) continue;
        GltfValue *used = list_of_used(file, arena);
        if (used->kind != GLTF_ARRAY) return; /* the check reports it */
        with_room(used, 1, arena)[used->count] = (GltfValue){.kind = GLTF_STRING, .text = name};
        used->count++;
        adopt(used);
    }
}

/* ---- all of it --------------------------------------------------------------------------- */

static void change_material(GltfFile *file, GltfValue *material, const SceneChange *change) {
    Error err;
    const GltfValue *patch;
    Arena *arena = &file->load->scratch;
    if (!gltf_json_parse(change->patch, strlen(change->patch), arena, &patch, &err)) {
        problems_add(file->load->problems, SEVERITY_ERROR, change->file, change->place, "%s",
                     err.text);
        return;
    }
    merge(material, patch, arena);
    add_used(file, patch);
}

void materials_change(GltfFile *file) {
    const SceneOptions *options = file->load->options;
    for (int i = 0; i < options->change_count; i++) {
        const SceneChange *change = &options->changes[i];
        if (change->kind != CHANGE_MATERIAL) continue;
        /* looked up each time: what was added to the root may have moved its members */
        for (int m = 0; m < tree_count(file->root, "materials"); m++) {
            const GltfValue *material = tree_element(file->root, "materials", m);
            if (strcmp(tree_text(material, "name", ""), change->name) != 0) continue;
            change_material(file, (GltfValue *)material, change);
            file->load->change_uses[i]++;
        }
    }
}
