/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/schema_extensions.h"

#include <string.h>

#include "base/count.h"
#include "scene/check/check_bytes.h"
#include "scene/check/check_document.h"
#include "scene/check/check_graph.h"
#include "scene/check/check_material.h"
#include "scene/check/check_optics.h"
#include "scene/gltf/foreign_extensions.h"
#include "scene/check/material_layers.h"
#include "scene/check/our_extensions.h"
#include "scene/check/schema_core.h"
#include "scene/gltf/document.h"

/* ---- lights ---------------------------------------------------------------------------- */

static const Schema SCHEMA_SPOT = {
    "light.spot", false, NULL,
    RULES({"innerConeAngle", RULE_NUMBER, .max = 1.5707963267948966},
          {"outerConeAngle", RULE_NUMBER, .flags = RULE_ABOVE_MIN, .max = 1.5707963267948968})};

static const Schema SCHEMA_LIGHT = {
    "light", false, check_light,
    RULES({"color", RULE_NUMBERS, .max = 1, .least = 3, .most = 3},
          {"intensity", RULE_NUMBER, .flags = RULE_FROM_MIN},
          {"spot", RULE_OBJECT, .schema = &SCHEMA_SPOT},
          {"type", RULE_TEXT, .flags = RULE_REQUIRED},
          {"range", RULE_NUMBER, .flags = RULE_FROM_MIN | RULE_ABOVE_MIN})};

static const Schema SCHEMA_LIGHTS = {
    "KHR_lights_punctual", false, NULL,
    RULES({"lights", RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_LIGHT})};

static const Schema SCHEMA_NODE_LIGHT = {"KHR_lights_punctual", false, NULL,
                                         RULES({"light", RULE_INDEX, .flags = RULE_REQUIRED,
                                                .of = "extensions/KHR_lights_punctual/lights"})};

static const Schema SCHEMA_PROFILE = {
    "light profile", false, check_source,
    RULES({"uri", .kind = RULE_TEXT}, {"mimeType", RULE_CHOICE, .of = "application/x-ies-lm-63"},
          {"bufferView", RULE_INDEX, .of = "bufferViews", .needs = "mimeType"})};

static const Schema SCHEMA_PROFILES = {
    "EXT_lights_ies", false, NULL,
    RULES({"lights", RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_PROFILE})};

static const Schema SCHEMA_NODE_PROFILE = {
    "EXT_lights_ies", false, NULL,
    RULES({"light", RULE_INDEX, .flags = RULE_REQUIRED, .of = "extensions/EXT_lights_ies/lights"},
          {"multiplier", RULE_NUMBER, .flags = RULE_FROM_MIN},
          {"color", RULE_NUMBERS, .max = 1, .least = 3, .most = 3})};

/* ---- materials ------------------------------------------------------------------------- */

static const Schema SCHEMA_EMISSIVE_STRENGTH = {
    "KHR_materials_emissive_strength", false, NULL,
    RULES({"emissiveStrength", RULE_NUMBER, .flags = RULE_FROM_MIN})};

static const Schema SCHEMA_UNLIT = {"KHR_materials_unlit", false, NULL, NO_RULES};

static const Schema SCHEMA_DISPERSION = {
    "KHR_materials_dispersion", false, NULL,
    RULES({"dispersion", RULE_NUMBER, .flags = RULE_FROM_MIN})};

static const Schema SCHEMA_GLOSSINESS = {
    "KHR_materials_pbrSpecularGlossiness", false, NULL,
    RULES({"diffuseFactor", RULE_NUMBERS, .max = 1, .least = 4, .most = 4},
          {"diffuseTexture", RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
          {"specularFactor", RULE_NUMBERS, .max = 1, .least = 3, .most = 3},
          {"glossinessFactor", RULE_NUMBER, .max = 1},
          {"specularGlossinessTexture", RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO})};

/* ---- the rest of Khronos' -------------------------------------------------------------- */

static const Schema SCHEMA_TEXTURE_TRANSFORM = {
    "KHR_texture_transform", false, NULL,
    RULES({"offset", RULE_NUMBERS, .least = 2, .most = 2}, {"rotation", .kind = RULE_NUMBER},
          {"scale", RULE_NUMBERS, .least = 2, .most = 2},
          {"texCoord", RULE_INTEGER, .max = 65535})};

static const Schema SCHEMA_WEBP = {"EXT_texture_webp", false, NULL,
                                   RULES({"source", RULE_INDEX, .of = "images"})};
static const Schema SCHEMA_BASISU = {"KHR_texture_basisu", false, NULL,
                                     RULES({"source", RULE_INDEX, .of = "images"})};

static const Schema SCHEMA_VARIANT = {"variant", false, NULL,
                                      RULES({"name", RULE_TEXT, .flags = RULE_REQUIRED})};
static const Schema SCHEMA_VARIANTS = {
    "KHR_materials_variants", false, check_variant_names,
    RULES({"variants", RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_VARIANT})};

static const Schema SCHEMA_MAPPING = {
    "mapping", false, NULL,
    RULES({"variants", RULE_INDICES, .flags = RULE_REQUIRED,
           .of = "extensions/KHR_materials_variants/variants"},
          {"material", RULE_INDEX, .flags = RULE_REQUIRED, .of = "materials"})};
static const Schema SCHEMA_MAPPINGS = {
    "KHR_materials_variants", false, check_variants,
    RULES({"mappings", RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_MAPPING})};

static const Schema SCHEMA_POINTER = {"KHR_animation_pointer", false, NULL,
                                      RULES({"pointer", RULE_TEXT, .flags = RULE_REQUIRED})};

static const Schema SCHEMA_VISIBILITY = {"KHR_node_visibility", false, NULL,
                                         RULES({"visible", .kind = RULE_BOOLEAN})};

/* ---- many of one mesh ------------------------------------------------------------------- */

static const Schema SCHEMA_INSTANCING = {
    INSTANCING_EXTENSION, false, check_instancing,
    RULES({"attributes", RULE_MAP, .flags = RULE_REQUIRED, .of = "accessors"})};

/* ---- EXT_meshopt_compression (the list under "JSON schema updates") ---------------------- */

static void check_stride(const DocumentCheck *check, const GltfValue *packed, double stride) {
    const GltfValue *at = tree_member(packed, "byteStride");
    const char *mode = tree_text(packed, "mode", ""), *filter = tree_text(packed, "filter", "");
    bool is_vertices = strcmp(mode, "ATTRIBUTES") == 0;
    if (is_vertices && fmod(stride, 4) != 0)
        check_fails(check, at, "is %g, with ATTRIBUTES a multiple of 4 is required", stride);
    if (!is_vertices && stride != 2 && stride != 4)
        check_fails(check, at, "is %g, with %.20s 2 or 4 is required", stride, mode);
    if (strcmp(filter, "OCTAHEDRAL") == 0 && stride != 4 && stride != 8)
        check_fails(check, at, "is %g, with OCTAHEDRAL 4 or 8 is required", stride);
    if (strcmp(filter, "QUATERNION") == 0 && stride != 8)
        check_fails(check, at, "is %g, with QUATERNION 8 is required", stride);
}

static void check_meshopt(const DocumentCheck *check, const GltfValue *packed) {
    const GltfValue *view = packed->parent->parent, *filter = tree_member(packed, "filter");
    const char *mode = tree_text(packed, "mode", "");
    double count = tree_number(packed, "count", 0);
    double stride = tree_number(packed, "byteStride", 0);
    double length = tree_number(view, "byteLength", count * stride);
    double own = tree_number(view, "byteStride", stride);
    check_place_in_buffer(check, packed);
    check_stride(check, packed, stride);
    if (own != stride)
        check_fails(check, packed, "unpacks to a byteStride of %g, the buffer view has %g", stride,
                    own);
    if (length != count * stride)
        check_fails(check, packed, "unpacks to %.15g bytes, the buffer view has %.15g",
                    count * stride, length);
    if (strcmp(mode, "TRIANGLES") == 0 && fmod(count, 3) != 0)
        check_fails(check, tree_member(packed, "count"),
                    "is %.15g, with TRIANGLES a multiple of 3 is required", count);
    if (filter && strcmp(mode, "ATTRIBUTES") != 0 && strcmp(filter->text, "NONE") != 0)
        check_fails(check, filter, "is \"%.20s\", with %.20s only NONE is required", filter->text,
                    mode);
}

static const Schema SCHEMA_MESHOPT = {
    MESHOPT_EXTENSION, false, check_meshopt,
    RULES({"buffer", RULE_INDEX, .flags = RULE_REQUIRED, .of = "buffers"},
          {"byteOffset", RULE_INTEGER, .max = RULE_MOST_BYTES},
          {"byteLength", RULE_INTEGER, .flags = RULE_REQUIRED, .min = 1, .max = RULE_MOST_BYTES},
          {"byteStride", RULE_INTEGER, .flags = RULE_REQUIRED, .min = 1, .max = 256},
          {"count", RULE_INTEGER, .flags = RULE_REQUIRED, .min = 1, .max = LOAD_MAX_ELEMENTS},
          {"mode", RULE_CHOICE, .flags = RULE_REQUIRED | RULE_CLOSED,
           .of = "ATTRIBUTES|TRIANGLES|INDICES"},
          {"filter", RULE_CHOICE, .flags = RULE_CLOSED,
           .of = "NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL"})};
static const Schema SCHEMA_MESHOPT_BUFFER = {MESHOPT_EXTENSION, false, NULL,
                                             RULES({"fallback", .kind = RULE_BOOLEAN})};

/* ---- KHR_draco_mesh_compression ---------------------------------------------------------- */

static void check_ids(const DocumentCheck *check, const GltfValue *ids, const GltfValue *own) {
    for (int i = 0; i < ids->count; i++) {
        const GltfValue *id = &ids->items[i];
        if (!tree_is_integer(id) || id->number < 0 || id->number > 4294967295.0)
            check_fails(check, id, "the id of an attribute is required, 0 to 4294967295");
        if (!tree_member(own, id->key))
            check_fails(check, id, "the primitive has no %.60s", id->key);
    }
}

static void check_draco(const DocumentCheck *check, const GltfValue *packed) {
    const GltfValue *primitive = packed->parent->parent;
    const GltfValue *ids = tree_member(packed, "attributes");
    const GltfValue *mode = tree_member(primitive, "mode");
    double code = tree_number(primitive, "mode", 4);
    if (ids && ids->kind == GLTF_OBJECT)
        check_ids(check, ids, tree_member(primitive, "attributes"));
    else if (ids) check_fails(check, ids, "an object of attributes is required");
    if (ids && !tree_member(ids, "POSITION")) check_fails(check, ids, "\"POSITION\" is missing");
    if (code != 4 && code != 5)
        check_fails(check, mode, "is %g, packed meshes are of mode 4 or 5", code);
    if (!tree_member(primitive, "indices"))
        check_fails(check, primitive, "\"indices\" is missing, which packed meshes have");
}

static const Schema SCHEMA_DRACO = {
    DRACO_EXTENSION, false, check_draco,
    RULES({"bufferView", RULE_INDEX, .flags = RULE_REQUIRED, .of = "bufferViews"},
          {"attributes", RULE_ANY, .flags = RULE_REQUIRED})};

/* ---- Microsoft Flight Simulator's ------------------------------------------------------- */

static const Schema SCHEMA_NORMAL_CONVENTION = {
    NORMAL_CONVENTION_EXTENSION, false, NULL,
    RULES(
        {"tangent_space_convention", RULE_CHOICE, .flags = RULE_REQUIRED, .of = "DirectX|OpenGL"})};

/* ---- where they stand ------------------------------------------------------------------ */

static const ExtensionRule EXTENSIONS[] = {
    {"KHR_lights_punctual", "document", &SCHEMA_LIGHTS},
    {"KHR_lights_punctual", "node", &SCHEMA_NODE_LIGHT},
    {"EXT_lights_ies", "document", &SCHEMA_PROFILES},
    {"EXT_lights_ies", "node", &SCHEMA_NODE_PROFILE},
    {"KHR_materials_emissive_strength", "material", &SCHEMA_EMISSIVE_STRENGTH},
    {"KHR_materials_dispersion", "material", &SCHEMA_DISPERSION},
    {"KHR_materials_unlit", "material", &SCHEMA_UNLIT},
    {"KHR_texture_transform", "textureInfo", &SCHEMA_TEXTURE_TRANSFORM},
    {"KHR_node_visibility", "node", &SCHEMA_VISIBILITY},
    {"EXT_texture_webp", "texture", &SCHEMA_WEBP},
    {INSTANCING_EXTENSION, "node", &SCHEMA_INSTANCING},
    {DRACO_EXTENSION, "mesh.primitive", &SCHEMA_DRACO},
    {MESHOPT_EXTENSION, "bufferView", &SCHEMA_MESHOPT},
    {MESHOPT_EXTENSION, "buffer", &SCHEMA_MESHOPT_BUFFER},
    {"KHR_animation_pointer", "animation.channel.target", &SCHEMA_POINTER},
    {"KHR_materials_variants", "document", &SCHEMA_VARIANTS},
    {"KHR_materials_variants", "mesh.primitive", &SCHEMA_MAPPINGS},
    {"PARHELION_display", "material", &our_schemas[OUR_DISPLAY]},
    {"PARHELION_environment", "scene", &our_schemas[OUR_ENVIRONMENT]},
    {"PARHELION_spectrum", "material", &our_schemas[OUR_SPECTRUM]},
    {"PARHELION_glazing", "material", &our_schemas[OUR_GLAZING]},
    {"PARHELION_coating", "material", &our_schemas[OUR_COATING]},
    {NORMAL_CONVENTION_EXTENSION, "asset", &SCHEMA_NORMAL_CONVENTION},
    {NORMAL_CONVENTION_EXTENSION, "document", &SCHEMA_NORMAL_CONVENTION},
    {"OpenMaterial_material_parameters", "material", NULL}, /* check_optics.c looks into it */
    {"OpenMaterial_asset_info", NULL, NULL},
    /* Without effect on the picture: who made it, what a hand may do with a node. */
    {"KHR_xmp_json_ld", NULL, NULL},
    {"KHR_node_selectability", NULL, NULL},
    {"KHR_node_hoverability", NULL, NULL},
    {"KHR_mesh_quantization", "", NULL}, /* it only widens what accessors may hold */
    /* Known, so that a wrong place or value can be reported, but not honoured: */
    {"KHR_materials_pbrSpecularGlossiness", "material", &SCHEMA_GLOSSINESS},
    {"KHR_texture_basisu", "texture", &SCHEMA_BASISU},
};

const ExtensionRule *extension_rule(const char *name, const char *host, bool *is_known) {
    const ExtensionRule *found = NULL;
    for (int i = 0; i < COUNT_OF(EXTENSIONS) + material_layer_count; i++) {
        const ExtensionRule *rule = i < COUNT_OF(EXTENSIONS)
                                        ? &EXTENSIONS[i]
                                        : &material_layers[i - COUNT_OF(EXTENSIONS)].rule;
        if (strcmp(rule->name, name) != 0) continue;
        *is_known = true;
        if (!rule->host || strcmp(rule->host, host) == 0) found = rule;
    }
    return found;
}

bool extension_is_supported(const char *name) {
    for (int i = 0; i < material_layer_count; i++)
        if (strcmp(material_layers[i].rule.name, name) == 0) return true;
    for (int i = 0; i < COUNT_OF(EXTENSIONS); i++) {
        if (strcmp(EXTENSIONS[i].name, name) == 0) return true;
        if (strcmp(EXTENSIONS[i].name, "KHR_mesh_quantization") == 0) return false;
    }
    return false;
}

/* ---- extensionsUsed and extensionsRequired --------------------------------------------- */

void check_extensions(const DocumentCheck *check, const GltfValue *root) {
    const GltfValue *used = tree_member(root, "extensionsUsed");
    const GltfValue *required = tree_member(root, "extensionsRequired");
    const GltfValue *name = tree_items(root, "extensionsRequired");
    char note[FOREIGN_NOTE_SIZE];
    for (; name; name = tree_next(name)) {
        if (name->kind != GLTF_STRING) continue;
        if (!extension_is_supported(name->text))
            check_fails(check, name,
                        "the file requires the extension \"%.80s\"%s, which is not supported",
                        name->text, foreign_extension_note(name->text, note));
        if (!tree_lists(used, name->text))
            check_warns(check, name, "\"%.80s\" is required but not listed in extensionsUsed",
                        name->text);
    }
    for (name = tree_items(root, "extensionsUsed"); name; name = tree_next(name)) {
        if (name->kind != GLTF_STRING || tree_lists(required, name->text)) continue;
        if (!extension_is_supported(name->text))
            check_warns(check, name,
                        "the extension \"%.80s\"%s is not supported: what it adds is not shown",
                        name->text, foreign_extension_note(name->text, note));
        else if (strcmp(name->text, "KHR_mesh_quantization") == 0)
            check_warns(check, name, "KHR_mesh_quantization must be listed in extensionsRequired");
    }
}
