/* SPDX-License-Identifier: Apache-2.0 */
/* The members of glTF 2.0's objects (Khronos glTF 2.0 specification, chapter 5). */
#include "scene/check/schema_core.h"

#include "scene/check/check_animation.h"
#include "scene/check/check_bytes.h"
#include "scene/check/check_document.h"
#include "scene/check/check_graph.h"
#include "scene/check/check_material.h"
#include "scene/check/check_mesh.h"
#include "scene/check/material_layers.h"

/* ---- bytes ----------------------------------------------------------------------------- */

static const Schema SCHEMA_BUFFER = {
    "buffer", false, NULL,
    RULES({"uri", .kind = RULE_TEXT},
          {"byteLength", RULE_INTEGER, .flags = RULE_REQUIRED, .min = 1, .max = RULE_MOST_BYTES})};

static const Schema SCHEMA_BUFFER_VIEW = {
    "bufferView", false, check_buffer_view,
    RULES({"buffer", RULE_INDEX, .flags = RULE_REQUIRED, .of = "buffers"},
          {"byteOffset", RULE_INTEGER, .max = RULE_MOST_BYTES},
          {"byteLength", RULE_INTEGER, .flags = RULE_REQUIRED, .min = 1, .max = RULE_MOST_BYTES},
          {"byteStride", RULE_INTEGER, .min = 4, .max = 252},
          {"target", RULE_CODE, .flags = RULE_WARNS, .of = "34962|34963"})};

static const Schema SCHEMA_SPARSE_INDICES = {
    "accessor.sparse.indices", false, NULL,
    RULES({"bufferView", RULE_INDEX, .flags = RULE_REQUIRED, .of = "bufferViews"},
          {"byteOffset", RULE_INTEGER, .max = 2147483647},
          {"componentType", RULE_CODE, .flags = RULE_REQUIRED, .of = "5121|5123|5125"})};

static const Schema SCHEMA_SPARSE_VALUES = {
    "accessor.sparse.values", false, NULL,
    RULES({"bufferView", RULE_INDEX, .flags = RULE_REQUIRED, .of = "bufferViews"},
          {"byteOffset", RULE_INTEGER, .max = 2147483647})};

static const Schema SCHEMA_SPARSE = {
    "accessor.sparse", false, NULL,
    RULES({"count", RULE_INTEGER, .flags = RULE_REQUIRED, .min = 1, .max = LOAD_MAX_ELEMENTS},
          {"indices", RULE_OBJECT, .flags = RULE_REQUIRED, .schema = &SCHEMA_SPARSE_INDICES},
          {"values", RULE_OBJECT, .flags = RULE_REQUIRED, .schema = &SCHEMA_SPARSE_VALUES})};

static const Schema SCHEMA_ACCESSOR = {
    "accessor", false, check_accessor,
    RULES(
        {"bufferView", RULE_INDEX, .of = "bufferViews"},
        {"byteOffset", RULE_INTEGER, .max = RULE_MOST_BYTES, .needs = "bufferView"},
        {"componentType", RULE_CODE, .flags = RULE_REQUIRED, .of = "5120|5121|5122|5123|5125|5126"},
        {"normalized", .kind = RULE_BOOLEAN},
        {"count", RULE_INTEGER, .flags = RULE_REQUIRED, .min = 1, .max = LOAD_MAX_ELEMENTS},
        {"type", RULE_CHOICE, .flags = RULE_REQUIRED, .of = "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"},
        {"max", RULE_NUMBERS, .flags = RULE_ANY_SIZE, .least = 1, .most = 16},
        {"min", RULE_NUMBERS, .flags = RULE_ANY_SIZE, .least = 1, .most = 16},
        {"sparse", RULE_OBJECT, .schema = &SCHEMA_SPARSE})};

/* ---- shapes ---------------------------------------------------------------------------- */

static const Schema SCHEMA_PRIMITIVE = {
    "mesh.primitive", false, check_primitive,
    RULES({"attributes", RULE_MAP, .flags = RULE_REQUIRED, .of = "accessors"},
          {"indices", RULE_INDEX, .of = "accessors"}, {"material", RULE_INDEX, .of = "materials"},
          {"mode", RULE_CODE, .of = "0|1|2|3|4|5|6"},
          {"targets", .kind = RULE_ANY})}; /* an array of maps: see check_primitive */

static const Schema SCHEMA_MESH = {
    "mesh", false, check_mesh,
    RULES({"primitives", RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_PRIMITIVE},
          {"weights", .kind = RULE_NUMBERS})};

static const Schema SCHEMA_SKIN = {
    "skin", false, check_skin,
    RULES({"inverseBindMatrices", RULE_INDEX, .of = "accessors"},
          {"skeleton", RULE_INDEX, .flags = RULE_WARNS, .of = "nodes"},
          {"joints", RULE_INDICES, .flags = RULE_REQUIRED, .of = "nodes"})};

static const Schema SCHEMA_NODE = {
    "node", false, check_node,
    RULES({"camera", RULE_INDEX, .of = "cameras"}, {"children", RULE_INDICES, .of = "nodes"},
          {"skin", RULE_INDEX, .of = "skins", .needs = "mesh"},
          {"matrix", RULE_NUMBERS, .least = 16, .most = 16}, {"mesh", RULE_INDEX, .of = "meshes"},
          {"rotation", RULE_NUMBERS, .min = -1, .max = 1, .least = 4, .most = 4},
          {"scale", RULE_NUMBERS, .least = 3, .most = 3},
          {"translation", RULE_NUMBERS, .least = 3, .most = 3},
          {"weights", RULE_NUMBERS, .needs = "mesh"})};

static const Schema SCHEMA_SCENE = {"scene", false, NULL,
                                    RULES({"nodes", RULE_INDICES, .of = "nodes"})};

/* ---- cameras --------------------------------------------------------------------------- */

static const Schema SCHEMA_PERSPECTIVE = {
    "camera.perspective", false, NULL,
    RULES({"aspectRatio", RULE_NUMBER, .flags = RULE_FROM_MIN | RULE_ABOVE_MIN},
          {"yfov", RULE_NUMBER, .flags = RULE_REQUIRED | RULE_FROM_MIN | RULE_ABOVE_MIN},
          {"zfar", RULE_NUMBER, .flags = RULE_FROM_MIN | RULE_ABOVE_MIN},
          {"znear", RULE_NUMBER, .flags = RULE_REQUIRED | RULE_FROM_MIN | RULE_ABOVE_MIN})};

static const Schema SCHEMA_ORTHOGRAPHIC = {
    "camera.orthographic", false, NULL,
    RULES({"xmag", RULE_NUMBER, .flags = RULE_REQUIRED},
          {"ymag", RULE_NUMBER, .flags = RULE_REQUIRED},
          {"zfar", RULE_NUMBER, .flags = RULE_REQUIRED | RULE_FROM_MIN | RULE_ABOVE_MIN},
          {"znear", RULE_NUMBER, .flags = RULE_REQUIRED | RULE_FROM_MIN})};

static const Schema SCHEMA_CAMERA = {
    "camera", false, check_camera,
    RULES({"orthographic", RULE_OBJECT, .schema = &SCHEMA_ORTHOGRAPHIC},
          {"perspective", RULE_OBJECT, .schema = &SCHEMA_PERSPECTIVE},
          {"type", RULE_CHOICE, .flags = RULE_REQUIRED, .of = "perspective|orthographic"})};

/* ---- pictures and materials ------------------------------------------------------------ */

static const Schema SCHEMA_IMAGE = {
    "image", false, check_source,
    RULES({"uri", .kind = RULE_TEXT},
          {"mimeType", RULE_CHOICE, .of = "image/jpeg|image/png|image/webp"},
          {"bufferView", RULE_INDEX, .of = "bufferViews", .needs = "mimeType"})};

static const Schema SCHEMA_SAMPLER = {
    "sampler", false, NULL,
    RULES({"magFilter", RULE_CODE, .of = "9728|9729"},
          {"minFilter", RULE_CODE, .of = "9728|9729|9984|9985|9986|9987"},
          {"wrapS", RULE_CODE, .of = "33071|33648|10497"},
          {"wrapT", RULE_CODE, .of = "33071|33648|10497"})};

static const Schema SCHEMA_TEXTURE = {
    "texture", false, NULL,
    RULES({"sampler", RULE_INDEX, .of = "samplers"}, {"source", RULE_INDEX, .of = "images"})};

static const Schema SCHEMA_OCCLUSION_TEXTURE_INFO = {
    "textureInfo", false, NULL,
    RULES({"index", RULE_INDEX, .flags = RULE_REQUIRED, .of = "textures"},
          {"texCoord", RULE_INTEGER, .max = 65535}, {"strength", RULE_NUMBER, .max = 1})};

static const Schema SCHEMA_PBR = {
    "material.pbrMetallicRoughness", false, NULL,
    RULES({"baseColorFactor", RULE_NUMBERS, .max = 1, .least = 4, .most = 4},
          {"baseColorTexture", RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
          {"metallicFactor", RULE_NUMBER, .max = 1}, {"roughnessFactor", RULE_NUMBER, .max = 1},
          {"metallicRoughnessTexture", RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO})};

static const Schema SCHEMA_MATERIAL = {
    "material", false, check_material,
    RULES({"pbrMetallicRoughness", RULE_OBJECT, .schema = &SCHEMA_PBR},
          {"normalTexture", RULE_OBJECT, .schema = &SCHEMA_NORMAL_TEXTURE_INFO},
          {"occlusionTexture", RULE_OBJECT, .schema = &SCHEMA_OCCLUSION_TEXTURE_INFO},
          {"emissiveTexture", RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
          {"emissiveFactor", RULE_NUMBERS, .max = 1, .least = 3, .most = 3},
          {"alphaMode", RULE_CHOICE, .of = "OPAQUE|MASK|BLEND"},
          {"alphaCutoff", RULE_NUMBER, .flags = RULE_FROM_MIN, .needs = "alphaMode"},
          {"doubleSided", .kind = RULE_BOOLEAN})};

/* ---- animations: at rest they are skipped, so that faults in them only warn ------------- */

static const Schema SCHEMA_TARGET = {"animation.channel.target", false, NULL,
                                     RULES({"node", RULE_INDEX, .of = "nodes"},
                                           {"path", RULE_CHOICE, .flags = RULE_REQUIRED,
                                            .of = "translation|rotation|scale|weights|pointer"})};

static const Schema SCHEMA_CHANNEL = {
    "animation.channel", false, NULL,
    RULES({"sampler", RULE_INTEGER, .flags = RULE_REQUIRED | RULE_FROM_MIN},
          {"target", RULE_OBJECT, .flags = RULE_REQUIRED, .schema = &SCHEMA_TARGET})};

static const Schema SCHEMA_ANIMATION_SAMPLER = {
    "animation.sampler", false, NULL,
    RULES({"input", RULE_INDEX, .flags = RULE_REQUIRED, .of = "accessors"},
          {"interpolation", RULE_CHOICE, .flags = RULE_CLOSED, .of = "LINEAR|STEP|CUBICSPLINE"},
          {"output", RULE_INDEX, .flags = RULE_REQUIRED, .of = "accessors"})};

static const Schema SCHEMA_ANIMATION = {
    "animation", false, check_animation,
    RULES({"channels", RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_CHANNEL},
          {"samplers", RULE_OBJECTS, .flags = RULE_REQUIRED, .schema = &SCHEMA_ANIMATION_SAMPLER})};

/* ---- the document ---------------------------------------------------------------------- */

static const Schema SCHEMA_ASSET = {"asset", false, check_asset,
                                    RULES({"copyright", RULE_TEXT, .flags = RULE_WARNS},
                                          {"generator", RULE_TEXT, .flags = RULE_WARNS},
                                          {"version", RULE_TEXT, .flags = RULE_REQUIRED},
                                          {"minVersion", .kind = RULE_TEXT})};

const Schema SCHEMA_ROOT = {
    "document", false, NULL,
    RULES({"extensionsUsed", .kind = RULE_TEXTS},
          {"extensionsRequired", RULE_TEXTS, .needs = "extensionsUsed"},
          {"accessors", RULE_OBJECTS, .schema = &SCHEMA_ACCESSOR},
          {"animations", RULE_OBJECTS, .flags = RULE_WARNS_AT_REST, .schema = &SCHEMA_ANIMATION},
          {"asset", RULE_OBJECT, .flags = RULE_REQUIRED, .schema = &SCHEMA_ASSET},
          {"buffers", RULE_OBJECTS, .schema = &SCHEMA_BUFFER},
          {"bufferViews", RULE_OBJECTS, .schema = &SCHEMA_BUFFER_VIEW},
          {"cameras", RULE_OBJECTS, .schema = &SCHEMA_CAMERA},
          {"images", RULE_OBJECTS, .schema = &SCHEMA_IMAGE},
          {"materials", RULE_OBJECTS, .schema = &SCHEMA_MATERIAL},
          {"meshes", RULE_OBJECTS, .schema = &SCHEMA_MESH},
          {"nodes", RULE_OBJECTS, .schema = &SCHEMA_NODE},
          {"samplers", RULE_OBJECTS, .schema = &SCHEMA_SAMPLER},
          {"scene", RULE_INDEX, .of = "scenes", .needs = "scenes"},
          {"scenes", RULE_OBJECTS, .schema = &SCHEMA_SCENE},
          {"skins", RULE_OBJECTS, .schema = &SCHEMA_SKIN},
          {"textures", RULE_OBJECTS, .schema = &SCHEMA_TEXTURE})};
