/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/texture_slot.h"

#include <string.h>

#include "base/count.h"
#include "base/mathd.h"
#include "scene/check/material_layers.h"
#include "scene/gltf/document.h"
#include "scene/load/image.h"

TextureSlot texture_slot_none(void) {
    return (TextureSlot){.texture_id = NO_ID, .uv_from_uv = {1, 0, 0, 0, 1, 0}};
}

/* KHR_texture_transform: uv' = T R S uv, where R is a turn by -rotation in the (u, v) plane as
 * the extension writes it: u' = sx cos u + sy sin v + ox, v' = -sx sin u + sy cos v + oy. */
static void apply_transform(const GltfValue *transform, TextureSlot *slot) {
    float offset[2] = {0, 0}, scale[2] = {1, 1};
    float turn = tree_float(transform, "rotation", 0);
    float c = cos_of(turn), s = sin_of(turn);
    tree_floats(transform, "offset", 2, offset);
    tree_floats(transform, "scale", 2, scale);
    float matrix[6] = {scale[0] * c,  scale[1] * s, offset[0],
                       -scale[0] * s, scale[1] * c, offset[1]};
    memcpy(slot->uv_from_uv, matrix, sizeof matrix);
    slot->uv_set = tree_int(transform, "texCoord", slot->uv_set);
}

TextureSlot texture_slot(GltfFile *file, const GltfValue *info) {
    TextureSlot slot = texture_slot_none();
    int index = tree_int(info, "index", NO_ID);
    if (index < 0) return slot;
    slot.texture_id = file->texture_base + index;
    slot.uv_set = tree_int(info, "texCoord", 0);
    const GltfValue *transform = tree_extension(info, "KHR_texture_transform");
    if (transform) apply_transform(transform, &slot);
    const Texture *texture = list_item(&file->load->textures, slot.texture_id);
    if (texture->image.width > 0) return slot;
    const GltfValue *own = tree_element(file->root, "textures", index);
    bool is_ktx2 = tree_extension(own, "KHR_texture_basisu") != NULL;
    if (texture_source(own) == NO_ID)
        file_warning(file, info,
                     is_ktx2 ? "texture %d has a KTX2 picture alone (KHR_texture_basisu), "
                               "which is not read: it is left out"
                             : "texture %d has no PNG, JPEG or WebP source: it is left out",
                     index);
    return texture_slot_none();
}

/* ---- which uv sets does a material need? ----------------------------------------------- */

#define MATERIAL_SLOTS_MAX 64 /* far more than there are */

/* Slots of the keys of a layer, from number `count` on; how many there are then. */
static int slots_of_layer(const Rule *key, void *layer, TextureSlot **slots, int count) {
    for (; key->name; key++)
        if (key->field.is_kept && key->kind == RULE_OBJECT && count < MATERIAL_SLOTS_MAX)
            slots[count++] = (void *)((char *)layer + key->field.at);
    return count;
}

/* All slots that a material has but a display's content; how many. */
static int slots_of(Material *m, TextureSlot *slots[MATERIAL_SLOTS_MAX]) {
    TextureSlot *core[] = {&m->base_color_texture, &m->metallic_roughness_texture,
                           &m->normal_texture, &m->emissive_texture};
    int count = COUNT_OF(core);
    memcpy(slots, core, sizeof core);
    for (int i = 0; i < material_layer_count; i++) {
        void *layer = material_layer_struct(&material_layers[i], m);
        if (layer)
            count = slots_of_layer(material_layers[i].rule.schema->rules, layer, slots, count);
    }
    return count;
}

/* Puts a set among the two; false when both are taken by others. */
static bool claim_set(int sets[SCENE_UV_SETS], int set) {
    for (int i = 0; i < SCENE_UV_SETS; i++) {
        if (sets[i] == NO_ID) sets[i] = set;
        if (sets[i] == set) return true;
    }
    return false;
}

/* Part.uv has two places: the smallest set that is used first, or set 0 where it fits, so
 * that uv[0] is what every viewer would show. */
static void order_sets(int sets[SCENE_UV_SETS]) {
    if (sets[1] == NO_ID && sets[0] > 0) sets[1] = 0;
    if (sets[0] == NO_ID) sets[0] = 0;
    if (sets[1] != NO_ID && sets[1] < sets[0]) {
        int first = sets[1];
        sets[1] = sets[0];
        sets[0] = first;
    }
    if (sets[1] == NO_ID) sets[1] = 1;
}

void texture_slots_place(GltfFile *file, const GltfValue *value, Material *material,
                         TextureSlot *content, int sets[SCENE_UV_SETS]) {
    TextureSlot *slots[MATERIAL_SLOTS_MAX + 1];
    int count = slots_of(material, slots);
    if (content) slots[count++] = content;
    sets[0] = sets[1] = NO_ID;
    for (int i = 0; i < count; i++) {
        if (slots[i]->texture_id == NO_ID) continue;
        if (!claim_set(sets, slots[i]->uv_set)) {
            file_error(file, value,
                       "the textures of \"%s\" use TEXCOORD_%d, _%d and _%d; at most "
                       "two sets are carried",
                       material->name, sets[0], sets[1], slots[i]->uv_set);
            return;
        }
    }
    order_sets(sets);
    for (int i = 0; i < count; i++) slots[i]->uv_set = slots[i]->uv_set == sets[1];
}

void texture_slots_used(const Loader *load, const Material *material,
                        bool uses_set[SCENE_UV_SETS]) {
    Material copy = *material;
    TextureSlot *slots[MATERIAL_SLOTS_MAX];
    int count = slots_of(&copy, slots);
    uses_set[0] = true;
    uses_set[1] = false;
    for (int i = 0; i < count; i++) uses_set[1] |= slots[i]->uv_set == 1;
    if (material->display_id == NO_ID) return;
    const Display *display = list_item(&load->displays, material->display_id);
    uses_set[1] |= display->content.uv_set == 1;
}
