/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/extras.h"

#include <string.h>

#include "scene/gltf/document.h"

/* A text becomes what it holds, in its place: it keeps its name and its way up, so that a
 * fault inside is reported with the pointer that a reader of the file can follow. */
static void unfold(GltfFile *file, GltfValue *text) {
    Error err;
    const GltfValue *held;
    if (!gltf_json_parse(text->text, strlen(text->text), &file->load->scratch, &held, &err)) {
        file_error(file, text, "is a text that is no JSON object: %s", err.text);
        return;
    }
    text->kind = held->kind;
    text->number = held->number;
    text->text = held->text;
    text->items = held->items;
    text->count = held->count;
    for (int i = 0; i < held->count; i++) ((GltfValue *)&held->items[i])->parent = text;
}

/* The tree lies in the loader's scratch and is this program's own until it is checked. */
static void unfold_all(GltfFile *file, const char *collection) {
    for (const GltfValue *one = tree_items(file->root, collection); one; one = tree_next(one))
        for (const GltfValue *e = tree_items(one, "extras"); e; e = tree_next(e)) {
            if (!extras_is_ours(e)) continue;
            load_note(file->load, &file->load->extensions, e->key);
            if (e->kind == GLTF_STRING) unfold(file, (GltfValue *)e);
        }
}

void extras_unfold(GltfFile *file) {
    unfold_all(file, "materials");
    unfold_all(file, "scenes");
}

bool extras_is_ours(const GltfValue *member) {
    return member->key && strncmp(member->key, TREE_OURS, strlen(TREE_OURS)) == 0;
}
