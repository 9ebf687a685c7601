/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/material_layers.h"

#include <stddef.h>
#include <string.h>

#include "base/count.h"
#include "scene/gltf/tree.h"

const Schema SCHEMA_TEXTURE_INFO = {
    "textureInfo", false, NULL,
    RULES({"index", RULE_INDEX, .flags = RULE_REQUIRED, .of = "textures"},
          {"texCoord", RULE_INTEGER, .max = 65535})};

const Schema SCHEMA_NORMAL_TEXTURE_INFO = {
    "textureInfo", false, NULL,
    RULES({"index", RULE_INDEX, .flags = RULE_REQUIRED, .of = "textures"},
          {"texCoord", RULE_INTEGER, .max = 65535}, {"scale", .kind = RULE_NUMBER})};

/* Of a key: the member of the struct that it fills, and a number's default. */
#define OF(Type, member, ...) .field = {true, offsetof(Type, member), __VA_ARGS__}
#define TEXTURE(Type, member) .schema = &SCHEMA_TEXTURE_INFO, OF(Type, member, 0)

/* Of a layer: the extension with its keys; the struct of its own that Material points to. */
#define LAYER(extension, more, ...) \
    .rule = {extension, "material", &(const Schema){extension, false, more, RULES(__VA_ARGS__)}}
#define OWN_STRUCT(Type, pointer) .size = sizeof(Type), .at = offsetof(Material, pointer)

/* Reflects all but 4e-5 of the light: a larger one would look like an infinite one. */
#define IOR_MAX 1e5

static void check_ior(const DocumentCheck *check, const GltfValue *extension) {
    double ior = tree_number(extension, "ior", 1.5);
    if ((ior > 0 && ior < 1) || ior > IOR_MAX)
        check_fails(check, tree_member(extension, "ior"),
                    "is %.9g, 0 (which means infinite) or a number from 1 to %.9g is required", ior,
                    IOR_MAX);
}

/* What is another surface altogether. */
static const char *const OTHER_SURFACES[] = {"PARHELION_coating", "PARHELION_glazing",
                                             "PARHELION_display", "KHR_materials_unlit", NULL};
#define HIDDEN_BY_COATING OTHER_SURFACES
#define HIDDEN (OTHER_SURFACES + 1)

const MaterialLayer material_layers[] = {
    {LAYER("KHR_materials_specular", NULL,
           {"specularFactor", RULE_NUMBER, .max = 1, OF(Material, specular, 1)},
           {"specularTexture", RULE_OBJECT, TEXTURE(Material, specular_texture)},
           {"specularColorFactor", RULE_NUMBERS, .flags = RULE_FROM_MIN, .least = 3, .most = 3,
            OF(Material, specular_color, 1)},
           {"specularColorTexture", RULE_OBJECT, TEXTURE(Material, specular_color_texture)})},
    {LAYER("KHR_materials_transmission", NULL,
           {"transmissionFactor", RULE_NUMBER, .max = 1, OF(Material, transmission, 0)},
           {"transmissionTexture", RULE_OBJECT, TEXTURE(Material, transmission_texture)})},
    {LAYER(
         "KHR_materials_clearcoat", NULL,
         {"clearcoatFactor", RULE_NUMBER, .max = 1, OF(Material, clearcoat, 0)},
         {"clearcoatTexture", RULE_OBJECT, TEXTURE(Material, clearcoat_texture)},
         {"clearcoatRoughnessFactor", RULE_NUMBER, .max = 1, OF(Material, clearcoat_roughness, 0)},
         {"clearcoatRoughnessTexture", RULE_OBJECT, TEXTURE(Material, clearcoat_roughness_texture)},
         {"clearcoatNormalTexture", RULE_OBJECT, .schema = &SCHEMA_NORMAL_TEXTURE_INFO,
          OF(Material, clearcoat_normal_texture, 0)}),
     .on_solid = ON_CLOSED_SOLID "on which no coat is shown"},
    {LAYER("KHR_materials_diffuse_transmission", NULL,
           {"diffuseTransmissionFactor", RULE_NUMBER, .max = 1,
            OF(Material, diffuse_transmission, 0)},
           {"diffuseTransmissionTexture", RULE_OBJECT,
            TEXTURE(Material, diffuse_transmission_texture)},
           {"diffuseTransmissionColorFactor", RULE_NUMBERS, .max = 1, .least = 3, .most = 3,
            OF(Material, diffuse_transmission_color, 1)},
           {"diffuseTransmissionColorTexture", RULE_OBJECT,
            TEXTURE(Material, diffuse_transmission_color_texture)}),
     .on_solid = "is not seen: KHR_materials_transmission makes the solid clear"},
    {LAYER("KHR_materials_volume", NULL, {"thicknessFactor", RULE_NUMBER, .flags = RULE_FROM_MIN},
           {"thicknessTexture", RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
           {"attenuationDistance", RULE_NUMBER, .flags = RULE_FROM_MIN | RULE_ABOVE_MIN,
            OF(Material, attenuation_distance_m, INFINITY)},
           {"attenuationColor", RULE_NUMBERS, .max = 1, .least = 3, .most = 3,
            OF(Material, attenuation_color, 1)})},
    {LAYER(
         "KHR_materials_iridescence", NULL,
         {"iridescenceFactor", RULE_NUMBER, .max = 1, OF(MaterialFilm, share, 0)},
         {"iridescenceTexture", RULE_OBJECT, TEXTURE(MaterialFilm, texture)},
         {"iridescenceIor", RULE_NUMBER, .min = 1, .max = IOR_MAX, OF(MaterialFilm, ior, 1.3f)},
         {"iridescenceThicknessMinimum", RULE_NUMBER, .max = 1e6, OF(MaterialFilm, least_nm, 100)},
         {"iridescenceThicknessMaximum", RULE_NUMBER, .max = 1e6, OF(MaterialFilm, most_nm, 400)},
         {"iridescenceThicknessTexture", RULE_OBJECT, TEXTURE(MaterialFilm, thickness_texture)}),
     OWN_STRUCT(MaterialFilm, film), .hidden_by = HIDDEN_BY_COATING},
    {LAYER("KHR_materials_anisotropy", NULL,
           {"anisotropyStrength", RULE_NUMBER, .max = 1, OF(Brushing, strength, 0)},
           {"anisotropyRotation", .kind = RULE_NUMBER, OF(Brushing, turn, 0)},
           {"anisotropyTexture", RULE_OBJECT, TEXTURE(Brushing, texture)}),
     OWN_STRUCT(Brushing, brushing), .hidden_by = HIDDEN},
    {LAYER("KHR_materials_sheen", NULL,
           {"sheenColorFactor", RULE_NUMBERS, .max = 1, .least = 3, .most = 3,
            OF(MaterialOverlay, color, 0)},
           {"sheenColorTexture", RULE_OBJECT, TEXTURE(MaterialOverlay, color_texture)},
           {"sheenRoughnessFactor", RULE_NUMBER, .max = 1, OF(MaterialOverlay, roughness, 0)},
           {"sheenRoughnessTexture", RULE_OBJECT, TEXTURE(MaterialOverlay, roughness_texture)}),
     OWN_STRUCT(MaterialOverlay, overlay), .hidden_by = HIDDEN,
     .on_solid = ON_CLOSED_SOLID "on which sheen is not shown"},
    {LAYER("KHR_materials_ior", check_ior,
           {"ior", RULE_NUMBER, .flags = RULE_FROM_MIN, OF(Material, ior, 1.5f)})},
};

const int material_layer_count = COUNT_OF(material_layers);

bool material_layer_shows(const MaterialLayer *layer, const GltfValue *extension) {
    const Rule *amount = layer->rule.schema->rules;
    const GltfValue *value = tree_member(extension, amount->name);
    bool shows = false;
    if (amount->kind == RULE_NUMBER) return tree_number(extension, amount->name, 0) > 0;
    for (int i = 0; value && i < value->count; i++) shows |= value->items[i].number > 0;
    return shows;
}

void *material_layer_struct(const MaterialLayer *layer, Material *material) {
    void *own;
    if (!layer->size) return material;
    memcpy(&own, (char *)material + layer->at, sizeof own);
    return own;
}
