/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_material.h"

#include <stdio.h>
#include <string.h>

#include "scene/check/check_optics.h"
#include "scene/gltf/extras.h"
#include "scene/gltf/variant.h"

/* ---- members that have no effect together ---------------------------------------------- */

static bool has_extension(const GltfValue *material, const char *const *names, int count) {
    for (int i = 0; i < count; i++)
        if (tree_extension(material, names[i])) return true;
    return false;
}

static void check_volume(const DocumentCheck *check, const GltfValue *material) {
    static const char *const WAYS_IN[] = {"KHR_materials_transmission",
                                          "KHR_materials_diffuse_transmission"};
    const GltfValue *volume = tree_extension(material, "KHR_materials_volume");
    if (volume && !has_extension(material, WAYS_IN, 2))
        check_warns(check, volume, "no light enters it: KHR_materials_transmission is missing");
}

/* Two answers to what the surface is: one of them is not seen. */
static void check_alone(const DocumentCheck *check, const GltfValue *material) {
    static const char *const ALONE[] = {"KHR_materials_unlit",
                                        "KHR_materials_pbrSpecularGlossiness"};
    const GltfValue *all = tree_member(material, "extensions");
    for (int i = 0; i < 2; i++) {
        const GltfValue *own = tree_extension(material, ALONE[i]);
        for (int k = 0; own && k < all->count; k++)
            if (&all->items[k] != own && strncmp(all->items[k].key, "KHR_", 4) == 0) {
                check_warns(check, &all->items[k], "is not made to stand beside %s", ALONE[i]);
                break;
            }
    }
}

static bool is_share(const GltfValue *value) {
    return value->kind == GLTF_NUMBER && value->number >= 0 && value->number <= 1;
}

void check_glazing_layer(const DocumentCheck *check, const GltfValue *layer) {
    const GltfValue *transmission = tree_member(layer, "transmission");
    bool is_file = transmission && transmission->kind == GLTF_STRING && transmission->text[0];
    if (transmission && !is_file && !is_share(transmission))
        check_fails(check, transmission,
                    "a number from 0 to 1, or the name of a CSV file of nm,value is required");
    const GltfValue *toward = tree_member(layer, "wedge_toward");
    if (toward && !tree_member(layer, "wedge_rad"))
        check_warns(check, toward, "stands there without \"wedge_rad\", which it needs");
    if (tree_number(layer, "wedge_rad", 0) > 0 && !toward)
        check_fails(check, layer, "a wedge without \"wedge_toward\": +u, -u, +v or -v is required");
}

/* Warns of properties that are not rendered on a pane and that other viewers do not need. */
static void check_beside_glazing(const DocumentCheck *check, const GltfValue *material) {
    static const char *const HIDDEN[] = {"KHR_materials_volume", "KHR_materials_clearcoat",
                                         "KHR_materials_diffuse_transmission"};
    const GltfValue *hidden = tree_member(material, "normalTexture");
    for (int i = 0; i <= 3; i++) {
        if (hidden) check_warns(check, hidden, "is not seen: PARHELION_glazing stands for it");
        hidden = i < 3 ? tree_extension(material, HIDDEN[i]) : NULL;
    }
}

/* A pane's face is identified by its name, and it lies in air. */
static void check_face_coating(const DocumentCheck *check, const GltfValue *coating) {
    const GltfValue *faces = tree_member(coating, "faces");
    double outside = tree_number(coating, "outside", 1);
    if (faces) check_fails(check, faces, "has no meaning here: \"%s\" is one face", coating->key);
    if (outside > 1)
        check_fails(check, tree_member(coating, "outside"),
                    "is %.9g, 1 is required: a pane stands in air", outside);
}

void check_glazing(const DocumentCheck *check, const GltfValue *glazing) {
    const GltfValue *layers = tree_member(glazing, "layers");
    const GltfValue *material = glazing->parent ? glazing->parent->parent : NULL;
    int wedges = 0;
    for (int i = 0; layers && layers->kind == GLTF_ARRAY && i < layers->count; i++) {
        wedges += tree_number(&layers->items[i], "wedge_rad", 0) > 0;
        if (wedges == 2)
            check_fails(check, &layers->items[i], "a second wedge; one layer may have one");
    }
    if (tree_extension(material, "PARHELION_display"))
        check_fails(check, glazing, "stands beside PARHELION_display: a pane is no display");
    if (tree_extension(material, "KHR_materials_unlit"))
        check_fails(check, glazing, "stands beside KHR_materials_unlit: a pane does not shine");
    check_face_coating(check, tree_member(glazing, "coating_outside"));
    check_face_coating(check, tree_member(glazing, "coating_inside"));
    check_beside_glazing(check, material);
}

void check_material(const DocumentCheck *check, const GltfValue *material) {
    check_volume(check, material);
    check_clear_solid(check, material);
    check_alone(check, material);
    check_coated_material(check, material);
    check_index(check, material);
}

/* ---- what a material needs of its primitives ------------------------------------------- */

static bool is_texture_info(const GltfValue *value) {
    size_t length = value->key ? strlen(value->key) : 0;
    bool is_named = (length >= 7 && strcmp(value->key + length - 7, "Texture") == 0) ||
                    (length == 7 && strcmp(value->key, "content") == 0);
    return is_named && value->kind == GLTF_OBJECT && tree_member(value, "index");
}

static int texcoord_of(const GltfValue *info) {
    return tree_int(tree_extension(info, "KHR_texture_transform"), "texCoord",
                    tree_int(info, "texCoord", 0));
}

/* The first set that a texture below `value` needs and the attributes do not have; NO_ID. */
static int missing_set(const GltfValue *value, const GltfValue *attributes) {
    bool is_extras = value->key && strcmp(value->key, "extras") == 0;
    if (is_texture_info(value)) {
        char name[24];
        int set = texcoord_of(value);
        snprintf(name, sizeof name, "TEXCOORD_%d", set);
        if (!tree_member(attributes, name)) return set;
    }
    for (int i = 0; value->kind == GLTF_OBJECT && i < value->count; i++) {
        if (is_extras && !extras_is_ours(&value->items[i])) continue;
        int set = missing_set(&value->items[i], attributes);
        if (set != NO_ID) return set;
    }
    return NO_ID;
}

/* A wedge's direction is given by texture coordinates. */
static bool has_wedge(const GltfValue *material) {
    const GltfValue *layers = tree_member(tree_extension(material, "PARHELION_glazing"), "layers");
    for (int i = 0; layers && layers->kind == GLTF_ARRAY && i < layers->count; i++)
        if (tree_number(&layers->items[i], "wedge_rad", 0) > 0) return true;
    return false;
}

/* Grooves and normal maps turn with the surface; only a normal map defines that frame. */
static void check_tangents(const DocumentCheck *check, const GltfValue *primitive,
                           const GltfValue *material, const char *name) {
    const GltfValue *attributes = tree_member(primitive, "attributes");
    const GltfValue *coat = tree_extension(material, "KHR_materials_clearcoat");
    const GltfValue *brushed = tree_extension(material, "KHR_materials_anisotropy");
    char uv[24];
    if (!brushed && !tree_member(coat, "clearcoatNormalTexture")) return;
    if (tree_member(attributes, "TANGENT") && tree_member(attributes, "NORMAL")) return;
    if (tree_member(material, "normalTexture")) return;
    const GltfValue *info = tree_member(brushed, "anisotropyTexture");
    snprintf(uv, sizeof uv, "TEXCOORD_%d", info ? texcoord_of(info) : 0);
    check_warns(check, primitive,
                "the material \"%.80s\" needs tangents: there is neither TANGENT nor a normal "
                "map to find them by%s",
                name,
                !brushed                      ? ""
                : tree_member(attributes, uv) ? ", its texture's coordinates are taken"
                                              : " nor texture coordinates, it is not brushed");
}

void check_material_fits(const DocumentCheck *check, const GltfValue *primitive) {
    const GltfValue *attributes = tree_member(primitive, "attributes");
    const GltfValue *material =
        tree_element(check->file->root, "materials", variant_material(check->file, primitive));
    if (!material || !attributes) return;
    char unnamed[32];
    snprintf(unnamed, sizeof unnamed, "material %d", material->index);
    const char *name = tree_text(material, "name", "");
    if (!name[0]) name = unnamed;
    int set = missing_set(material, attributes);
    if (set != NO_ID)
        check_warns(check, primitive,
                    "the material \"%.80s\" needs TEXCOORD_%d, which is not there: (0, 0) is "
                    "taken",
                    name, set);
    if (has_wedge(material) && !tree_member(attributes, "TEXCOORD_0"))
        check_fails(check, primitive,
                    "the wedge of \"%.80s\" needs TEXCOORD_0, which is not there: it tells "
                    "where u and v grow",
                    name);
    check_tangents(check, primitive, material, name);
}
