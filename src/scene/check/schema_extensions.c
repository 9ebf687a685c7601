/* SPDX-License-Identifier: Apache-2.0 */
/* The extensions: where each may stand, what it holds, and which are honoured. */
#include "scene/check/schema_extensions.h"

#include <string.h>

#include "base/count.h"
#include "scene/check/check_coating.h"
#include "scene/check/check_document.h"
#include "scene/check/check_graph.h"
#include "scene/check/check_material.h"
#include "scene/check/check_packed.h"
#include "scene/check/schema_core.h"
#include "scene/gltf/document.h"

/* ---- lights ---------------------------------------------------------------------------- */

static const Rule SPOT[] = {
    {.name = "innerConeAngle", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE,
     .max = 1.5707963267948966},
    {.name = "outerConeAngle", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE | RULE_ABOVE_MIN,
     .max = 1.5707963267948968},
};
static const Schema SCHEMA_SPOT = {"light.spot", SPOT, COUNT_OF(SPOT), false, NULL};

static const Rule LIGHT[] = {
    {.name = "color", .kind = RULE_NUMBERS, .flags = RULE_HAS_RANGE, .max = 1, .least = 3,
     .most = 3},
    {.name = "intensity", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN},
    {.name = "spot", .kind = RULE_OBJECT, .schema = &SCHEMA_SPOT},
    {.name = "type", .kind = RULE_TEXT, .flags = RULE_REQUIRED},
    {.name = "range", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN | RULE_ABOVE_MIN},
};
static const Schema SCHEMA_LIGHT = {"light", LIGHT, COUNT_OF(LIGHT), false, check_light};

static const Rule LIGHTS[] = {
    {.name = "lights", .kind = RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_LIGHT}};
static const Schema SCHEMA_LIGHTS = {"KHR_lights_punctual", LIGHTS, COUNT_OF(LIGHTS), false,
                                     NULL};

static const Rule NODE_LIGHT[] = {{.name = "light",
                                   .kind = RULE_INDEX,
                                   .flags = RULE_REQUIRED,
                                   .of = "extensions/KHR_lights_punctual/lights"}};
static const Schema SCHEMA_NODE_LIGHT = {"KHR_lights_punctual", NODE_LIGHT,
                                         COUNT_OF(NODE_LIGHT), false, NULL};

static const Rule PROFILE[] = {
    {.name = "uri", .kind = RULE_TEXT},
    {.name = "mimeType", .kind = RULE_CHOICE, .of = "application/x-ies-lm-63"},
    {.name = "bufferView", .kind = RULE_INDEX, .of = "bufferViews", .needs = "mimeType"},
};
static const Schema SCHEMA_PROFILE = {"light profile", PROFILE, COUNT_OF(PROFILE), false,
                                      check_profile};

static const Rule PROFILES[] = {{.name = "lights",
                                 .kind = RULE_OBJECTS,
                                 .flags = RULE_REQUIRED,
                                 .schema = &SCHEMA_PROFILE}};
static const Schema SCHEMA_PROFILES = {"EXT_lights_ies", PROFILES, COUNT_OF(PROFILES), false,
                                       NULL};

static const Rule NODE_PROFILE[] = {
    {.name = "light", .kind = RULE_INDEX, .flags = RULE_REQUIRED,
     .of = "extensions/EXT_lights_ies/lights"},
    {.name = "multiplier", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN},
    {.name = "color", .kind = RULE_NUMBERS, .flags = RULE_HAS_RANGE, .max = 1, .least = 3,
     .most = 3},
};
static const Schema SCHEMA_NODE_PROFILE = {"EXT_lights_ies", NODE_PROFILE,
                                           COUNT_OF(NODE_PROFILE), false, NULL};

/* ---- materials ------------------------------------------------------------------------- */

static const Rule EMISSIVE_STRENGTH[] = {
    {.name = "emissiveStrength", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN}};
static const Schema SCHEMA_EMISSIVE_STRENGTH = {"KHR_materials_emissive_strength",
                                                EMISSIVE_STRENGTH, COUNT_OF(EMISSIVE_STRENGTH),
                                                false, NULL};

static const Schema SCHEMA_UNLIT = {"KHR_materials_unlit", NULL, 0, false, NULL};

static const Rule SPECULAR[] = {
    {.name = "specularFactor", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1},
    {.name = "specularTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
    {.name = "specularColorFactor", .kind = RULE_NUMBERS, .flags = RULE_FROM_MIN, .least = 3,
     .most = 3},
    {.name = "specularColorTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
};
static const Schema SCHEMA_SPECULAR = {"KHR_materials_specular", SPECULAR, COUNT_OF(SPECULAR),
                                       false, NULL};

static const Rule TRANSMISSION[] = {
    {.name = "transmissionFactor", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1},
    {.name = "transmissionTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
};
static const Schema SCHEMA_TRANSMISSION = {"KHR_materials_transmission", TRANSMISSION,
                                           COUNT_OF(TRANSMISSION), false, NULL};

static const Rule CLEARCOAT[] = {
    {.name = "clearcoatFactor", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1},
    {.name = "clearcoatTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
    {.name = "clearcoatRoughnessFactor", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE,
     .max = 1},
    {.name = "clearcoatRoughnessTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
    {.name = "clearcoatNormalTexture", .kind = RULE_OBJECT,
     .schema = &SCHEMA_NORMAL_TEXTURE_INFO},
};
static const Schema SCHEMA_CLEARCOAT = {"KHR_materials_clearcoat", CLEARCOAT,
                                        COUNT_OF(CLEARCOAT), false, NULL};

static const Rule VOLUME[] = {
    {.name = "thicknessFactor", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN},
    {.name = "thicknessTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
    {.name = "attenuationDistance", .kind = RULE_NUMBER,
     .flags = RULE_FROM_MIN | RULE_ABOVE_MIN},
    {.name = "attenuationColor", .kind = RULE_NUMBERS, .flags = RULE_HAS_RANGE, .max = 1,
     .least = 3, .most = 3},
};
static const Schema SCHEMA_VOLUME = {"KHR_materials_volume", VOLUME, COUNT_OF(VOLUME), false,
                                     NULL};

/* Reflects all but 4e-5 of the light: a larger one would look like an infinite one. */
#define IOR_MAX 1e5

static const Rule IOR[] = {{.name = "ior", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN}};
static void check_ior(const DocumentCheck *check, const GltfValue *extension)
{
    double ior = tree_number(extension, "ior", 1.5);
    if ((ior > 0 && ior < 1) || ior > IOR_MAX)
        check_fails(check, tree_member(extension, "ior"),
                    "is %.9g, 0 (which means infinite) or a number from 1 to %.9g is wanted",
                    ior, IOR_MAX);
}
static const Schema SCHEMA_IOR = {"KHR_materials_ior", IOR, COUNT_OF(IOR), false, check_ior};

static const Rule ANISOTROPY[] = {
    {.name = "anisotropyStrength", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1},
    {.name = "anisotropyRotation", .kind = RULE_NUMBER},
    {.name = "anisotropyTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
};
static const Schema SCHEMA_ANISOTROPY = {"KHR_materials_anisotropy", ANISOTROPY,
                                         COUNT_OF(ANISOTROPY), false, NULL};

#define TEXTURE(member)                                                                        \
    {.name = (member), .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO}
#define UNIT_NUMBER(member)                                                                    \
    {.name = (member), .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1}
#define UNIT_NUMBERS(member, size)                                                             \
    {.name = (member), .kind = RULE_NUMBERS, .flags = RULE_HAS_RANGE, .max = 1,                \
     .least = (size), .most = (size)}

static const Rule IRIDESCENCE[] = {
    UNIT_NUMBER("iridescenceFactor"),
    TEXTURE("iridescenceTexture"),
    {.name = "iridescenceIor", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .min = 1,
     .max = IOR_MAX},
    {.name = "iridescenceThicknessMinimum", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE,
     .max = 1e6},
    {.name = "iridescenceThicknessMaximum", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE,
     .max = 1e6},
    TEXTURE("iridescenceThicknessTexture"),
};
static const Schema SCHEMA_IRIDESCENCE = {"KHR_materials_iridescence", IRIDESCENCE,
                                          COUNT_OF(IRIDESCENCE), false, NULL};

static const Rule SHEEN[] = {UNIT_NUMBERS("sheenColorFactor", 3), TEXTURE("sheenColorTexture"),
                             UNIT_NUMBER("sheenRoughnessFactor"),
                             TEXTURE("sheenRoughnessTexture")};
static const Schema SCHEMA_SHEEN = {"KHR_materials_sheen", SHEEN, COUNT_OF(SHEEN), false, NULL};

static const Rule DISPERSION[] = {
    {.name = "dispersion", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN}};
static const Schema SCHEMA_DISPERSION = {"KHR_materials_dispersion", DISPERSION,
                                         COUNT_OF(DISPERSION), false, NULL};

static const Rule DIFFUSE_TRANSMISSION[] = {
    UNIT_NUMBER("diffuseTransmissionFactor"), TEXTURE("diffuseTransmissionTexture"),
    UNIT_NUMBERS("diffuseTransmissionColorFactor", 3),
    TEXTURE("diffuseTransmissionColorTexture")};
static const Schema SCHEMA_DIFFUSE_TRANSMISSION = {"KHR_materials_diffuse_transmission",
                                                   DIFFUSE_TRANSMISSION,
                                                   COUNT_OF(DIFFUSE_TRANSMISSION), false, NULL};

static const Rule GLOSSINESS[] = {UNIT_NUMBERS("diffuseFactor", 4), TEXTURE("diffuseTexture"),
                                  UNIT_NUMBERS("specularFactor", 3),
                                  UNIT_NUMBER("glossinessFactor"),
                                  TEXTURE("specularGlossinessTexture")};
static const Schema SCHEMA_GLOSSINESS = {"KHR_materials_pbrSpecularGlossiness", GLOSSINESS,
                                         COUNT_OF(GLOSSINESS), false, NULL};

/* ---- the rest of Khronos' -------------------------------------------------------------- */

static const Rule TEXTURE_TRANSFORM[] = {
    {.name = "offset", .kind = RULE_NUMBERS, .least = 2, .most = 2},
    {.name = "rotation", .kind = RULE_NUMBER},
    {.name = "scale", .kind = RULE_NUMBERS, .least = 2, .most = 2},
    {.name = "texCoord", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .max = 65535},
};
static const Schema SCHEMA_TEXTURE_TRANSFORM = {"KHR_texture_transform", TEXTURE_TRANSFORM,
                                                COUNT_OF(TEXTURE_TRANSFORM), false, NULL};

static const Rule OTHER_SOURCE[] = {{.name = "source", .kind = RULE_INDEX, .of = "images"}};
static const Schema SCHEMA_WEBP = {"EXT_texture_webp", OTHER_SOURCE, COUNT_OF(OTHER_SOURCE),
                                   false, NULL};
static const Schema SCHEMA_BASISU = {"KHR_texture_basisu", OTHER_SOURCE,
                                     COUNT_OF(OTHER_SOURCE), false, NULL};

static const Rule VARIANT[] = {{.name = "name", .kind = RULE_TEXT, .flags = RULE_REQUIRED}};
static const Schema SCHEMA_VARIANT = {"variant", VARIANT, COUNT_OF(VARIANT), false, NULL};
static const Rule VARIANTS[] = {{.name = "variants",
                                 .kind = RULE_OBJECTS,
                                 .flags = RULE_REQUIRED,
                                 .schema = &SCHEMA_VARIANT}};
static const Schema SCHEMA_VARIANTS = {"KHR_materials_variants", VARIANTS, COUNT_OF(VARIANTS),
                                       false, check_variant_names};

static const Rule MAPPING[] = {
    {.name = "variants", .kind = RULE_INDICES, .flags = RULE_REQUIRED,
     .of = "extensions/KHR_materials_variants/variants"},
    {.name = "material", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "materials"},
};
static const Schema SCHEMA_MAPPING = {"mapping", MAPPING, COUNT_OF(MAPPING), false, NULL};
static const Rule MAPPINGS[] = {{.name = "mappings",
                                 .kind = RULE_OBJECTS,
                                 .flags = RULE_REQUIRED,
                                 .schema = &SCHEMA_MAPPING}};
static const Schema SCHEMA_MAPPINGS = {"KHR_materials_variants", MAPPINGS, COUNT_OF(MAPPINGS),
                                       false, check_variants};

static const Rule POINTER[] = {{.name = "pointer", .kind = RULE_TEXT, .flags = RULE_REQUIRED}};
static const Schema SCHEMA_POINTER = {"KHR_animation_pointer", POINTER, COUNT_OF(POINTER),
                                      false, check_animation_pointer};

static const Rule VISIBILITY[] = {{.name = "visible", .kind = RULE_BOOLEAN}};
static const Schema SCHEMA_VISIBILITY = {"KHR_node_visibility", VISIBILITY,
                                         COUNT_OF(VISIBILITY), false, NULL};

/* ---- ours (formats: files that users write) -------------------------------------------- */

static void check_subpixels(const DocumentCheck *check, const GltfValue *subpixels)
{
    const GltfValue *columns = tree_member(subpixels, "columns");
    const GltfValue *rows = tree_member(subpixels, "rows");
    if (!columns != !rows)
        check_fails(check, columns ? columns : rows, "is there without \"%s\"",
                    columns ? "rows" : "columns");
    if (strcmp(tree_text(subpixels, "layout", ""), "none") != 0) return;
    static const char *const beside[] = {"fill", "columns", "rows"};
    for (int i = 0; i < COUNT_OF(beside); i++) {
        const GltfValue *member = tree_member(subpixels, beside[i]);
        if (member) check_fails(check, member, "is there beside the layout \"none\"");
    }
}

static const Rule SUBPIXELS[] = {
    {.name = "layout", .kind = RULE_CHOICE, .flags = RULE_REQUIRED | RULE_CLOSED,
     .of = "stripe|pentile|none"},
    {.name = "fill", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .min = 0.01, .max = 1},
    {.name = "columns", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .min = 1, .max = 65536},
    {.name = "rows", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .min = 1, .max = 65536},
};
static const Schema SCHEMA_SUBPIXELS = {"subpixels", SUBPIXELS, COUNT_OF(SUBPIXELS), true,
                                        check_subpixels};

static const Rule DISPLAY[] = {
    {.name = "panel", .kind = RULE_TEXT},
    {.name = "content", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
    {.name = "level", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN},
    {.name = "subpixels", .kind = RULE_OBJECT, .schema = &SCHEMA_SUBPIXELS},
};
static const Schema SCHEMA_DISPLAY = {"PARHELION_display", DISPLAY, COUNT_OF(DISPLAY), true,
                                      check_display};

static const Rule SUN[] = {
    {.name = "azimuth_deg", .kind = RULE_NUMBER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .min = -360, .max = 360},
    {.name = "elevation_deg", .kind = RULE_NUMBER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .min = -90, .max = 90},
    {.name = "illuminance_lx", .kind = RULE_NUMBER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .max = SCENE_MOST_LX},
    {.name = "angular_radius_deg", .kind = RULE_NUMBER,
     .flags = RULE_HAS_RANGE | RULE_ABOVE_MIN, .max = 45},
};
static const Schema SCHEMA_SUN = {"sun", SUN, COUNT_OF(SUN), true, NULL};

static const Rule ENVIRONMENT[] = {
    {.name = "type", .kind = RULE_CHOICE, .flags = RULE_REQUIRED | RULE_CLOSED,
     .of = "constant|hdri|cie|perez|sky"},
    {.name = "heading_deg", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .min = -360,
     .max = 360},
    {.name = "forward", .kind = RULE_NUMBERS, .least = 3, .most = 3},
    {.name = "sun", .kind = RULE_OBJECT, .schema = &SCHEMA_SUN},
    {.name = "luminance", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE,
     .max = SCENE_MOST_CD_M2},
    {.name = "color", .kind = RULE_NUMBERS, .flags = RULE_FROM_MIN, .least = 3, .most = 3},
    {.name = "uri", .kind = RULE_TEXT},
    {.name = "rotation_deg", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .min = -360,
     .max = 360},
    {.name = "scale", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = SCENE_MOST_CD_M2},
    {.name = "horizontal_illuminance_lx", .kind = RULE_NUMBER,
     .flags = RULE_HAS_RANGE | RULE_ABOVE_MIN, .max = SCENE_MOST_LX},
    {.name = "sky", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .min = 1, .max = 15},
    {.name = "diffuse_horizontal_lx", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE,
     .max = SCENE_MOST_LX},
    {.name = "direct_normal_w_m2", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE,
     .max = SCENE_MOST_W_M2},
    {.name = "diffuse_horizontal_w_m2", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE,
     .max = SCENE_MOST_W_M2},
    {.name = "when", .kind = RULE_TEXT},
    {.name = "where", .kind = RULE_NUMBERS, .least = 2, .most = 3},
    {.name = "turbidity", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .min = 1, .max = 30},
    {.name = "visibility_km", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN | RULE_ABOVE_MIN},
    {.name = "ozone_atm_cm", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 2},
    {.name = "water_cm", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 20},
    {.name = "albedo", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1},
    {.name = "ground", .kind = RULE_CHOICE, .flags = RULE_CLOSED, .of = "land|sea|cloud"},
    {.name = "cloud_top_m", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN},
    {.name = "moon", .kind = RULE_BOOLEAN},
};
static const Schema SCHEMA_ENVIRONMENT = {"PARHELION_environment", ENVIRONMENT,
                                          COUNT_OF(ENVIRONMENT), true, check_environment};

static const Rule SPECTRUM[] = {{.name = "baseColor", .kind = RULE_TEXT},
                                {.name = "transmission", .kind = RULE_TEXT},
                                {.name = "specular", .kind = RULE_TEXT},
                                {.name = "conductor", .kind = RULE_TEXT},
                                {.name = "emission", .kind = RULE_TEXT}};
static const Schema SCHEMA_SPECTRUM = {"PARHELION_spectrum", SPECTRUM, COUNT_OF(SPECTRUM), true,
                                       NULL};

static const Rule THIN_LAYER[] = {
    {.name = "n", .kind = RULE_ANY, .flags = RULE_REQUIRED},
    {.name = "k", .kind = RULE_ANY},
    {.name = "thickness_nm", .kind = RULE_NUMBER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .max = 1e6},
};
static const Schema SCHEMA_THIN_LAYER = {"layer", THIN_LAYER, COUNT_OF(THIN_LAYER), true,
                                         check_layer};

static const Rule COATING[] = {
    {.name = "layers", .kind = RULE_OBJECTS, .flags = RULE_MAY_BE_EMPTY,
     .schema = &SCHEMA_THIN_LAYER},
    {.name = "stack", .kind = RULE_TEXT},
    {.name = "outside", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .min = 1, .max = 10},
    {.name = "faces", .kind = RULE_CHOICE, .flags = RULE_CLOSED, .of = "both|front|back"},
};
static const Schema SCHEMA_COATING = {"PARHELION_coating", COATING, COUNT_OF(COATING), true,
                                      check_coating};

static const Rule LAYER[] = {
    {.name = "thickness_m", .kind = RULE_NUMBER,
     .flags = RULE_REQUIRED | RULE_HAS_RANGE | RULE_ABOVE_MIN, .max = 0.1},
    {.name = "ior", .kind = RULE_NUMBER, .flags = RULE_REQUIRED | RULE_HAS_RANGE, .min = 1,
     .max = 4},
    {.name = "transmission", .kind = RULE_ANY},
    {.name = "wedge_rad", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 0.01},
    {.name = "wedge_toward", .kind = RULE_CHOICE, .flags = RULE_CLOSED, .of = "+u|-u|+v|-v",
     .needs = "wedge_rad"},
};
static const Schema SCHEMA_LAYER = {"layer", LAYER, COUNT_OF(LAYER), true,
                                    check_glazing_layer};

static const Rule HAZE[] = {
    {.name = "share", .kind = RULE_NUMBER, .flags = RULE_REQUIRED | RULE_HAS_RANGE, .max = 1},
    {.name = "width_deg", .kind = RULE_NUMBER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .min = 0.1, .max = 60},
};
static const Schema SCHEMA_HAZE = {"haze", HAZE, COUNT_OF(HAZE), true, NULL};

static const Rule GLAZING[] = {
    {.name = "layers", .kind = RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_LAYER,
     .least = 1, .most = GLAZING_LAYERS_MAX},
    {.name = "haze", .kind = RULE_OBJECT, .schema = &SCHEMA_HAZE},
    {.name = "coating_outside", .kind = RULE_OBJECT, .schema = &SCHEMA_COATING},
    {.name = "coating_inside", .kind = RULE_OBJECT, .schema = &SCHEMA_COATING},
};
static const Schema SCHEMA_GLAZING = {"PARHELION_glazing", GLAZING, COUNT_OF(GLAZING), true,
                                      check_glazing};

static const Rule INSTANCING[] = {
    {.name = "attributes", .kind = RULE_MAP, .flags = RULE_REQUIRED, .of = "accessors"}};
static const Schema SCHEMA_INSTANCING = {INSTANCING_EXTENSION, INSTANCING,
                                         COUNT_OF(INSTANCING), false, check_instancing};

/* ---- where they stand ------------------------------------------------------------------ */

static const ExtensionRule EXTENSIONS[] = {
    {"KHR_lights_punctual", "document", &SCHEMA_LIGHTS},
    {"KHR_lights_punctual", "node", &SCHEMA_NODE_LIGHT},
    {"EXT_lights_ies", "document", &SCHEMA_PROFILES},
    {"EXT_lights_ies", "node", &SCHEMA_NODE_PROFILE},
    {"KHR_materials_emissive_strength", "material", &SCHEMA_EMISSIVE_STRENGTH},
    {"KHR_materials_ior", "material", &SCHEMA_IOR},
    {"KHR_materials_specular", "material", &SCHEMA_SPECULAR},
    {"KHR_materials_transmission", "material", &SCHEMA_TRANSMISSION},
    {"KHR_materials_clearcoat", "material", &SCHEMA_CLEARCOAT},
    {"KHR_materials_volume", "material", &SCHEMA_VOLUME},
    {"KHR_materials_dispersion", "material", &SCHEMA_DISPERSION},
    {"KHR_materials_diffuse_transmission", "material", &SCHEMA_DIFFUSE_TRANSMISSION},
    {"KHR_materials_unlit", "material", &SCHEMA_UNLIT},
    {"KHR_materials_iridescence", "material", &SCHEMA_IRIDESCENCE},
    {"KHR_materials_anisotropy", "material", &SCHEMA_ANISOTROPY},
    {"KHR_materials_sheen", "material", &SCHEMA_SHEEN},
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
    {"PARHELION_display", "material", &SCHEMA_DISPLAY},
    {"PARHELION_environment", "scene", &SCHEMA_ENVIRONMENT},
    {"PARHELION_spectrum", "material", &SCHEMA_SPECTRUM},
    {"PARHELION_glazing", "material", &SCHEMA_GLAZING},
    {"PARHELION_coating", "material", &SCHEMA_COATING},
    {"OpenMaterial_material_parameters", "material", NULL}, /* check_index.c looks into it */
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

const ExtensionRule *extension_rule(const char *name, const char *host, bool *is_known)
{
    const ExtensionRule *found = NULL;
    for (int i = 0; i < COUNT_OF(EXTENSIONS); i++) {
        if (strcmp(EXTENSIONS[i].name, name) != 0) continue;
        *is_known = true;
        if (!EXTENSIONS[i].host || strcmp(EXTENSIONS[i].host, host) == 0)
            found = &EXTENSIONS[i];
    }
    return found;
}

bool extension_is_supported(const char *name)
{
    for (int i = 0; i < COUNT_OF(EXTENSIONS); i++) {
        if (strcmp(EXTENSIONS[i].name, name) == 0) return true;
        if (strcmp(EXTENSIONS[i].name, "KHR_mesh_quantization") == 0) return false;
    }
    return false;
}

/* ---- extensionsUsed and extensionsRequired --------------------------------------------- */

static bool lists(const GltfValue *array, const char *text)
{
    for (int i = 0; array && array->kind == GLTF_ARRAY && i < array->count; i++)
        if (strcmp(array->items[i].text, text) == 0) return true;
    return false;
}

void check_extensions(const DocumentCheck *check, const GltfValue *root)
{
    const GltfValue *used = tree_member(root, "extensionsUsed");
    const GltfValue *required = tree_member(root, "extensionsRequired");
    for (int i = 0; required && i < required->count; i++) {
        const GltfValue *name = &required->items[i];
        if (name->kind != GLTF_STRING) continue;
        if (!extension_is_supported(name->text))
            check_fails(check, name,
                        "the file requires the extension \"%.80s\", which is not "
                        "supported",
                        name->text);
        if (!lists(used, name->text))
            check_warns(check, name, "\"%.80s\" is required but not listed in extensionsUsed",
                        name->text);
    }
    for (int i = 0; used && i < used->count; i++) {
        const GltfValue *name = &used->items[i];
        if (name->kind != GLTF_STRING || lists(required, name->text)) continue;
        if (!extension_is_supported(name->text))
            check_warns(check, name,
                        "the extension \"%.80s\" is not supported: what it adds is "
                        "not shown",
                        name->text);
        else if (strcmp(name->text, "KHR_mesh_quantization") == 0)
            check_warns(check, name,
                        "KHR_mesh_quantization must be listed in extensionsRequired");
    }
}
