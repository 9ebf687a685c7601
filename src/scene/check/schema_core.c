/* SPDX-License-Identifier: Apache-2.0 */
/* The members of glTF 2.0's objects (Khronos glTF 2.0 specification, chapter 5). */
#include "scene/check/schema_core.h"

#include "base/count.h"
#include "scene/check/check_animation.h"
#include "scene/check/check_bytes.h"
#include "scene/check/check_document.h"
#include "scene/check/check_graph.h"
#include "scene/check/check_material.h"
#include "scene/check/check_mesh.h"

#define BIG 9007199254740992.0 /* 2^53: what a double counts exactly */

/* ---- bytes ----------------------------------------------------------------------------- */

static const Rule BUFFER[] = {
    {.name = "uri", .kind = RULE_TEXT},
    {.name = "byteLength", .kind = RULE_INTEGER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .min = 1, .max = BIG},
};
static const Schema SCHEMA_BUFFER = {"buffer", BUFFER, COUNT_OF(BUFFER), false, NULL};

static const Rule BUFFER_VIEW[] = {
    {.name = "buffer", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "buffers"},
    {.name = "byteOffset", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .max = BIG},
    {.name = "byteLength", .kind = RULE_INTEGER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .min = 1, .max = BIG},
    {.name = "byteStride", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .min = 4, .max = 252},
    {.name = "target", .kind = RULE_CODE, .flags = RULE_WARNS, .of = "34962|34963"},
};
static const Schema SCHEMA_BUFFER_VIEW = {"bufferView", BUFFER_VIEW, COUNT_OF(BUFFER_VIEW),
                                          false, check_buffer_view};

static const Rule SPARSE_INDICES[] = {
    {.name = "bufferView", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "bufferViews"},
    {.name = "byteOffset", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .max = 2147483647},
    {.name = "componentType", .kind = RULE_CODE, .flags = RULE_REQUIRED,
     .of = "5121|5123|5125"},
};
static const Schema SCHEMA_SPARSE_INDICES = {"accessor.sparse.indices", SPARSE_INDICES,
                                             COUNT_OF(SPARSE_INDICES), false, NULL};

static const Rule SPARSE_VALUES[] = {
    {.name = "bufferView", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "bufferViews"},
    {.name = "byteOffset", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .max = 2147483647},
};
static const Schema SCHEMA_SPARSE_VALUES = {"accessor.sparse.values", SPARSE_VALUES,
                                            COUNT_OF(SPARSE_VALUES), false, NULL};

static const Rule SPARSE[] = {
    {.name = "count", .kind = RULE_INTEGER, .flags = RULE_REQUIRED | RULE_HAS_RANGE, .min = 1,
     .max = LOAD_MAX_ELEMENTS},
    {.name = "indices", .kind = RULE_OBJECT, .flags = RULE_REQUIRED,
     .schema = &SCHEMA_SPARSE_INDICES},
    {.name = "values", .kind = RULE_OBJECT, .flags = RULE_REQUIRED,
     .schema = &SCHEMA_SPARSE_VALUES},
};
static const Schema SCHEMA_SPARSE = {"accessor.sparse", SPARSE, COUNT_OF(SPARSE), false, NULL};

static const Rule ACCESSOR[] = {
    {.name = "bufferView", .kind = RULE_INDEX, .of = "bufferViews"},
    {.name = "byteOffset", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .max = BIG,
     .needs = "bufferView"},
    {.name = "componentType", .kind = RULE_CODE, .flags = RULE_REQUIRED,
     .of = "5120|5121|5122|5123|5125|5126"},
    {.name = "normalized", .kind = RULE_BOOLEAN},
    {.name = "count", .kind = RULE_INTEGER, .flags = RULE_REQUIRED | RULE_HAS_RANGE, .min = 1,
     .max = LOAD_MAX_ELEMENTS},
    {.name = "type", .kind = RULE_CHOICE, .flags = RULE_REQUIRED,
     .of = "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"},
    {.name = "max", .kind = RULE_NUMBERS, .flags = RULE_ANY_SIZE, .least = 1, .most = 16},
    {.name = "min", .kind = RULE_NUMBERS, .flags = RULE_ANY_SIZE, .least = 1, .most = 16},
    {.name = "sparse", .kind = RULE_OBJECT, .schema = &SCHEMA_SPARSE},
};
static const Schema SCHEMA_ACCESSOR = {"accessor", ACCESSOR, COUNT_OF(ACCESSOR), false,
                                       check_accessor};

/* ---- shapes ---------------------------------------------------------------------------- */

static const Rule PRIMITIVE[] = {
    {.name = "attributes", .kind = RULE_MAP, .flags = RULE_REQUIRED, .of = "accessors"},
    {.name = "indices", .kind = RULE_INDEX, .of = "accessors"},
    {.name = "material", .kind = RULE_INDEX, .of = "materials"},
    {.name = "mode", .kind = RULE_CODE, .of = "0|1|2|3|4|5|6"},
    {.name = "targets", .kind = RULE_ANY}, /* an array of maps: see check_primitive */
};
static const Schema SCHEMA_PRIMITIVE = {"mesh.primitive", PRIMITIVE, COUNT_OF(PRIMITIVE), false,
                                        check_primitive};

static const Rule MESH[] = {
    {.name = "primitives", .kind = RULE_OBJECTS, .flags = RULE_REQUIRED,
     .schema = &SCHEMA_PRIMITIVE},
    {.name = "weights", .kind = RULE_NUMBERS},
};
static const Schema SCHEMA_MESH = {"mesh", MESH, COUNT_OF(MESH), false, check_mesh};

static const Rule SKIN[] = {
    {.name = "inverseBindMatrices", .kind = RULE_INDEX, .of = "accessors"},
    {.name = "skeleton", .kind = RULE_INDEX, .flags = RULE_WARNS, .of = "nodes"},
    {.name = "joints", .kind = RULE_INDICES, .flags = RULE_REQUIRED, .of = "nodes"},
};
static const Schema SCHEMA_SKIN = {"skin", SKIN, COUNT_OF(SKIN), false, check_skin};

static const Rule NODE[] = {
    {.name = "camera", .kind = RULE_INDEX, .of = "cameras"},
    {.name = "children", .kind = RULE_INDICES, .of = "nodes"},
    {.name = "skin", .kind = RULE_INDEX, .of = "skins", .needs = "mesh"},
    {.name = "matrix", .kind = RULE_NUMBERS, .least = 16, .most = 16},
    {.name = "mesh", .kind = RULE_INDEX, .of = "meshes"},
    {.name = "rotation", .kind = RULE_NUMBERS, .flags = RULE_HAS_RANGE, .min = -1, .max = 1,
     .least = 4, .most = 4},
    {.name = "scale", .kind = RULE_NUMBERS, .least = 3, .most = 3},
    {.name = "translation", .kind = RULE_NUMBERS, .least = 3, .most = 3},
    {.name = "weights", .kind = RULE_NUMBERS, .needs = "mesh"},
};
static const Schema SCHEMA_NODE = {"node", NODE, COUNT_OF(NODE), false, check_node};

static const Rule SCENE[] = {{.name = "nodes", .kind = RULE_INDICES, .of = "nodes"}};
static const Schema SCHEMA_SCENE = {"scene", SCENE, COUNT_OF(SCENE), false, NULL};

/* ---- cameras --------------------------------------------------------------------------- */

static const Rule PERSPECTIVE[] = {
    {.name = "aspectRatio", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN | RULE_ABOVE_MIN},
    {.name = "yfov", .kind = RULE_NUMBER,
     .flags = RULE_REQUIRED | RULE_FROM_MIN | RULE_ABOVE_MIN},
    {.name = "zfar", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN | RULE_ABOVE_MIN},
    {.name = "znear", .kind = RULE_NUMBER,
     .flags = RULE_REQUIRED | RULE_FROM_MIN | RULE_ABOVE_MIN},
};
static const Schema SCHEMA_PERSPECTIVE = {"camera.perspective", PERSPECTIVE,
                                          COUNT_OF(PERSPECTIVE), false, NULL};

static const Rule ORTHOGRAPHIC[] = {
    {.name = "xmag", .kind = RULE_NUMBER, .flags = RULE_REQUIRED},
    {.name = "ymag", .kind = RULE_NUMBER, .flags = RULE_REQUIRED},
    {.name = "zfar", .kind = RULE_NUMBER,
     .flags = RULE_REQUIRED | RULE_FROM_MIN | RULE_ABOVE_MIN},
    {.name = "znear", .kind = RULE_NUMBER, .flags = RULE_REQUIRED | RULE_FROM_MIN},
};
static const Schema SCHEMA_ORTHOGRAPHIC = {"camera.orthographic", ORTHOGRAPHIC,
                                           COUNT_OF(ORTHOGRAPHIC), false, NULL};

static const Rule CAMERA[] = {
    {.name = "orthographic", .kind = RULE_OBJECT, .schema = &SCHEMA_ORTHOGRAPHIC},
    {.name = "perspective", .kind = RULE_OBJECT, .schema = &SCHEMA_PERSPECTIVE},
    {.name = "type", .kind = RULE_CHOICE, .flags = RULE_REQUIRED,
     .of = "perspective|orthographic"},
};
static const Schema SCHEMA_CAMERA = {"camera", CAMERA, COUNT_OF(CAMERA), false, check_camera};

/* ---- pictures and materials ------------------------------------------------------------ */

static const Rule IMAGE[] = {
    {.name = "uri", .kind = RULE_TEXT},
    {.name = "mimeType", .kind = RULE_CHOICE, .of = "image/jpeg|image/png|image/webp"},
    {.name = "bufferView", .kind = RULE_INDEX, .of = "bufferViews", .needs = "mimeType"},
};
static const Schema SCHEMA_IMAGE = {"image", IMAGE, COUNT_OF(IMAGE), false, check_image};

static const Rule SAMPLER[] = {
    {.name = "magFilter", .kind = RULE_CODE, .of = "9728|9729"},
    {.name = "minFilter", .kind = RULE_CODE, .of = "9728|9729|9984|9985|9986|9987"},
    {.name = "wrapS", .kind = RULE_CODE, .of = "33071|33648|10497"},
    {.name = "wrapT", .kind = RULE_CODE, .of = "33071|33648|10497"},
};
static const Schema SCHEMA_SAMPLER = {"sampler", SAMPLER, COUNT_OF(SAMPLER), false, NULL};

static const Rule TEXTURE[] = {
    {.name = "sampler", .kind = RULE_INDEX, .of = "samplers"},
    {.name = "source", .kind = RULE_INDEX, .of = "images"},
};
static const Schema SCHEMA_TEXTURE = {"texture", TEXTURE, COUNT_OF(TEXTURE), false,
                                      check_texture};

#define TEXTURE_INDEX                                                                          \
    {.name = "index", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "textures"}
#define TEXTURE_COORDINATES                                                                    \
    {.name = "texCoord", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .max = 65535}
static const Rule TEXTURE_INFO[] = {TEXTURE_INDEX, TEXTURE_COORDINATES};
const Schema SCHEMA_TEXTURE_INFO = {"textureInfo", TEXTURE_INFO, COUNT_OF(TEXTURE_INFO), false,
                                    NULL};

static const Rule NORMAL_TEXTURE_INFO[] = {TEXTURE_INDEX, TEXTURE_COORDINATES,
                                           {.name = "scale", .kind = RULE_NUMBER}};
const Schema SCHEMA_NORMAL_TEXTURE_INFO = {"textureInfo", NORMAL_TEXTURE_INFO,
                                           COUNT_OF(NORMAL_TEXTURE_INFO), false, NULL};

static const Rule OCCLUSION_TEXTURE_INFO[] = {
    TEXTURE_INDEX, TEXTURE_COORDINATES,
    {.name = "strength", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1}};
static const Schema SCHEMA_OCCLUSION_TEXTURE_INFO = {"textureInfo", OCCLUSION_TEXTURE_INFO,
                                                     COUNT_OF(OCCLUSION_TEXTURE_INFO), false,
                                                     NULL};

static const Rule PBR[] = {
    {.name = "baseColorFactor", .kind = RULE_NUMBERS, .flags = RULE_HAS_RANGE, .max = 1,
     .least = 4, .most = 4},
    {.name = "baseColorTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
    {.name = "metallicFactor", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1},
    {.name = "roughnessFactor", .kind = RULE_NUMBER, .flags = RULE_HAS_RANGE, .max = 1},
    {.name = "metallicRoughnessTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
};
static const Schema SCHEMA_PBR = {"material.pbrMetallicRoughness", PBR, COUNT_OF(PBR), false,
                                  NULL};

static const Rule MATERIAL[] = {
    {.name = "pbrMetallicRoughness", .kind = RULE_OBJECT, .schema = &SCHEMA_PBR},
    {.name = "normalTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_NORMAL_TEXTURE_INFO},
    {.name = "occlusionTexture", .kind = RULE_OBJECT,
     .schema = &SCHEMA_OCCLUSION_TEXTURE_INFO},
    {.name = "emissiveTexture", .kind = RULE_OBJECT, .schema = &SCHEMA_TEXTURE_INFO},
    {.name = "emissiveFactor", .kind = RULE_NUMBERS, .flags = RULE_HAS_RANGE, .max = 1,
     .least = 3, .most = 3},
    {.name = "alphaMode", .kind = RULE_CHOICE, .of = "OPAQUE|MASK|BLEND"},
    {.name = "alphaCutoff", .kind = RULE_NUMBER, .flags = RULE_FROM_MIN, .needs = "alphaMode"},
    {.name = "doubleSided", .kind = RULE_BOOLEAN},
};
static const Schema SCHEMA_MATERIAL = {"material", MATERIAL, COUNT_OF(MATERIAL), false,
                                       check_material};

/* ---- animations: at rest they are skipped, so that faults in them only warn ------------- */

static const Rule TARGET[] = {
    {.name = "node", .kind = RULE_INDEX, .of = "nodes"},
    {.name = "path", .kind = RULE_CHOICE, .flags = RULE_REQUIRED,
     .of = "translation|rotation|scale|weights|pointer"},
};
static const Schema SCHEMA_TARGET = {"animation.channel.target", TARGET, COUNT_OF(TARGET),
                                     false, NULL};

static const Rule CHANNEL[] = {
    {.name = "sampler", .kind = RULE_INTEGER, .flags = RULE_REQUIRED | RULE_FROM_MIN},
    {.name = "target", .kind = RULE_OBJECT, .flags = RULE_REQUIRED, .schema = &SCHEMA_TARGET},
};
static const Schema SCHEMA_CHANNEL = {"animation.channel", CHANNEL, COUNT_OF(CHANNEL), false,
                                      NULL};

static const Rule ANIMATION_SAMPLER[] = {
    {.name = "input", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "accessors"},
    {.name = "interpolation", .kind = RULE_CHOICE, .flags = RULE_CLOSED,
     .of = "LINEAR|STEP|CUBICSPLINE"},
    {.name = "output", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "accessors"},
};
static const Schema SCHEMA_ANIMATION_SAMPLER = {"animation.sampler", ANIMATION_SAMPLER,
                                                COUNT_OF(ANIMATION_SAMPLER), false, NULL};

static const Rule ANIMATION[] = {
    {.name = "channels", .kind = RULE_OBJECTS, .flags = RULE_REQUIRED,
     .schema = &SCHEMA_CHANNEL},
    {.name = "samplers", .kind = RULE_OBJECTS, .flags = RULE_REQUIRED,
     .schema = &SCHEMA_ANIMATION_SAMPLER},
};
static const Schema SCHEMA_ANIMATION = {"animation", ANIMATION, COUNT_OF(ANIMATION), false,
                                        check_animation};

/* ---- the document ---------------------------------------------------------------------- */

static const Rule ASSET[] = {
    {.name = "copyright", .kind = RULE_TEXT, .flags = RULE_WARNS},
    {.name = "generator", .kind = RULE_TEXT, .flags = RULE_WARNS},
    {.name = "version", .kind = RULE_TEXT, .flags = RULE_REQUIRED},
    {.name = "minVersion", .kind = RULE_TEXT},
};
static const Schema SCHEMA_ASSET = {"asset", ASSET, COUNT_OF(ASSET), false, check_asset};

static const Rule ROOT[] = {
    {.name = "extensionsUsed", .kind = RULE_TEXTS},
    {.name = "extensionsRequired", .kind = RULE_TEXTS, .needs = "extensionsUsed"},
    {.name = "accessors", .kind = RULE_OBJECTS, .schema = &SCHEMA_ACCESSOR},
    {.name = "animations", .kind = RULE_OBJECTS, .flags = RULE_WARNS_AT_REST,
     .schema = &SCHEMA_ANIMATION},
    {.name = "asset", .kind = RULE_OBJECT, .flags = RULE_REQUIRED, .schema = &SCHEMA_ASSET},
    {.name = "buffers", .kind = RULE_OBJECTS, .schema = &SCHEMA_BUFFER},
    {.name = "bufferViews", .kind = RULE_OBJECTS, .schema = &SCHEMA_BUFFER_VIEW},
    {.name = "cameras", .kind = RULE_OBJECTS, .schema = &SCHEMA_CAMERA},
    {.name = "images", .kind = RULE_OBJECTS, .schema = &SCHEMA_IMAGE},
    {.name = "materials", .kind = RULE_OBJECTS, .schema = &SCHEMA_MATERIAL},
    {.name = "meshes", .kind = RULE_OBJECTS, .schema = &SCHEMA_MESH},
    {.name = "nodes", .kind = RULE_OBJECTS, .schema = &SCHEMA_NODE},
    {.name = "samplers", .kind = RULE_OBJECTS, .schema = &SCHEMA_SAMPLER},
    {.name = "scene", .kind = RULE_INDEX, .of = "scenes", .needs = "scenes"},
    {.name = "scenes", .kind = RULE_OBJECTS, .schema = &SCHEMA_SCENE},
    {.name = "skins", .kind = RULE_OBJECTS, .schema = &SCHEMA_SKIN},
    {.name = "textures", .kind = RULE_OBJECTS, .schema = &SCHEMA_TEXTURE},
};
const Schema SCHEMA_ROOT = {"document", ROOT, COUNT_OF(ROOT), false, NULL};
