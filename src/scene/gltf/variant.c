/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/variant.h"

#include <string.h>

#include "scene/gltf/document.h"

#define EXTENSION "KHR_materials_variants"

/* The first of several with one name is meant: the check warns of them. */
static bool is_repeated(const GltfValue *variants, int index, const char *name) {
    for (int i = 0; i < index; i++)
        if (strcmp(tree_text(&variants->items[i], "name", ""), name) == 0) return true;
    return false;
}

void variant_choose(GltfFile *file) {
    Loader *load = file->load;
    const SceneState *state = &load->options->state;
    const GltfValue *variants = tree_member(tree_extension(file->root, EXTENSION), "variants");
    const char *before = NULL;
    file->variant_id = NO_ID;
    for (int i = 0; variants && variants->kind == GLTF_ARRAY && i < variants->count; i++) {
        const char *name = tree_text(&variants->items[i], "name", "");
        if (!name[0] || is_repeated(variants, i, name)) continue;
        load_note(load, &load->variants, name);
        if (!load_is_among(name, state->variants, state->variant_count)) continue;
        if (before)
            file_error(file, variants,
                       "--variant chooses \"%.80s\" and \"%.80s\" of this file; one is "
                       "required",
                       before, name);
        before = name;
        file->variant_id = i;
    }
}

static bool names_variant(const GltfValue *mapping, int variant) {
    for (const GltfValue *v = tree_items(mapping, "variants"); v; v = tree_next(v))
        if (tree_whole(v, NO_ID) == variant) return true;
    return false;
}

int variant_material(const GltfFile *file, const GltfValue *primitive) {
    const GltfValue *mappings = tree_member(tree_extension(primitive, EXTENSION), "mappings");
    for (int i = 0; file->variant_id != NO_ID && mappings && i < mappings->count; i++)
        if (names_variant(&mappings->items[i], file->variant_id))
            return tree_int(&mappings->items[i], "material", NO_ID);
    return tree_int(primitive, "material", NO_ID);
}
