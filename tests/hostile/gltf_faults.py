# SPDX-License-Identifier: Apache-2.0
"""gltf_faults.py -- faults by the validator's codes, each with what is said of it: part of
gltf_codes.py.

A fault is a code, a text that must stand among what `check` says of the broken model and not of
the whole one, and edits of the model (gltf_edits.py). A code that is refused elsewhere and only
reported here, as the page says, has a ~ behind it; one that is refused only here a !.
"""
import struct

from gltf_edits import (chunks, drop, glb, header, image, poke, poke_view, put, shift_view,
                        text, view_of)
from gltf_model import (BLENDS, INDICES, JOINTS, NORMAL, PICTURE, POSITION, SHIFTS, TIMES,
                        TURNS, data_uri)


MATERIAL = "materials/0/"
PBR = MATERIAL + "pbrMetallicRoughness/"
EXTENSION = MATERIAL + "extensions/KHR_materials_"
PRIMITIVE = "meshes/0/primitives/0/"
ATTRIBUTES = PRIMITIVE + "attributes/"
SAMPLERS = "animations/0/samplers/"
CHANNELS = "animations/0/channels/"
LIGHT = "extensions/KHR_lights_punctual/lights/0/"
UNIT = "a number from 0 to 1"


SCHEMA = [
    ("IO_ERROR", "No such file", image("none.png")),
    ("IO_ERROR", "No such file", put("buffer", {"uri": "none.bin"})),
    ("ARRAY_LENGTH_NOT_IN_LIST", "an array of 3 is required",
     put("nodes/4/scale", [1, 1])),
    ("ARRAY_LENGTH_NOT_IN_LIST", "an array of 2 is required",
     put(PBR + "baseColorTexture/extensions/KHR_texture_transform/scale", [1])),
    ("ARRAY_TYPE_MISMATCH", "a number is required", put("nodes/4/scale", [1, "1", 1])),
    ("ARRAY_TYPE_MISMATCH", "a text is required", put("extensionsUsed/0", 7)),
    ("ARRAY_TYPE_MISMATCH", "an object is required", put("materials/1", "glass")),
    ("INVALID_INDEX", "an index into meshes", put("nodes/8/mesh", -1)),
    ("INVALID_INDEX", "an index into textures", put(MATERIAL + "normalTexture/index", 0.5)),
    ("INVALID_JSON", "not valid JSON", text(lambda data: data[:-1])),
    ("INVALID_JSON", "not valid JSON", text(lambda data: b"\xff\xfe" + data)),
    ("INVALID_JSON", "not valid JSON", text(lambda data: data.replace(b"lamp", b"l\xe4mp"))),
    ("INVALID_URI", "broken escape", image("a%zz.png")),
    ("INVALID_URI", "no scheme stands", image(":a.png")),
    ("INVALID_URI", "has no comma", put("buffer", {"uri": "data:application/octet-stream"})),
    ("ONE_OF_MISMATCH", "has both", put("images/0/uri", "a.png")),
    ("ONE_OF_MISMATCH", "has neither", drop("images/1/uri")),
    ("ONE_OF_MISMATCH", "one is required",
     put("cameras/0/orthographic", {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 10})),
    ("PATTERN_MISMATCH", "a version like", put("asset/version", "2")),
    ("PATTERN_MISMATCH", "a version like", put("asset/minVersion", "two")),
    ("TYPE_MISMATCH", "a text is required", put("nodes/0/name", 5)),
    ("TYPE_MISMATCH", "true or false", put(MATERIAL + "doubleSided", 1)),
    ("TYPE_MISMATCH", "an array is required", put("nodes", {})),
    ("TYPE_MISMATCH", "is 1.5, one of", put("samplers/0/wrapS", 1.5)),
    ("UNDEFINED_PROPERTY", "\"byteLength\" is missing", drop("bufferViews/0/byteLength")),
    ("UNDEFINED_PROPERTY", "\"perspective\" is missing", drop("cameras/0/perspective")),
    ("UNDEFINED_PROPERTY", "\"spot\" is missing", drop(LIGHT + "spot")),
    ("UNDEFINED_PROPERTY", "\"asset\" is missing", drop("asset")),
    ("UNEXPECTED_PROPERTY", "is \"mesh\" meant?", put("nodes/8/mehs", 0)),
    ("UNEXPECTED_PROPERTY", "is no member", put(PBR + "baseColorTexture/strength", 1)),
    ("UNSATISFIED_DEPENDENCY", "without \"bufferView\"", drop("accessors/13/bufferView"),
     put("accessors/13/byteOffset", 4)),
    ("UNSATISFIED_DEPENDENCY", "without \"alphaMode\"", put(MATERIAL + "alphaCutoff", 0.5)),
    ("UNSATISFIED_DEPENDENCY", "without \"extensionsUsed\"", drop("extensionsUsed")),
    ("UNSATISFIED_DEPENDENCY", "without \"mimeType\"", drop("images/0/mimeType")),
    ("UNSATISFIED_DEPENDENCY", "without \"mesh\"", put("nodes/3/skin", 0)),
    ("UNSATISFIED_DEPENDENCY", "without \"mesh\"", put("nodes/3/weights", [1])),
    ("VALUE_MULTIPLE_OF", "a multiple of 4", view_of(POSITION, "byteStride", 14)),
    ("VALUE_NOT_IN_LIST", "one of OPAQUE", put("materials/1/alphaMode", "CUTOUT")),
    ("VALUE_NOT_IN_LIST", "one of 33071", put("samplers/0/wrapS", 7)),
    ("VALUE_NOT_IN_LIST", "one of LINEAR", put(SAMPLERS + "0/interpolation", "EASE")),
    ("VALUE_NOT_IN_LIST", "one of point", put(LIGHT + "type", "tube")),
]


SCHEMA += [
    ("VALUE_NOT_IN_LIST!", "VEC3 is required", put("accessors/0/type", "TENSOR")),
    ("VALUE_NOT_IN_LIST!", "SCALAR of UNSIGNED_BYTE (5121)",
     put("accessors/7/componentType", 5124)),
]


def ranges():
    """VALUE_NOT_IN_RANGE of every property that has one: (place, values just outside)."""
    ior = "materials/0/extensions/KHR_materials_ior/ior"
    share = [PBR + "metallicFactor", PBR + "roughnessFactor",
             MATERIAL + "occlusionTexture/strength", EXTENSION + "specular/specularFactor",
             EXTENSION + "transmission/transmissionFactor",
             EXTENSION + "clearcoat/clearcoatFactor",
             EXTENSION + "clearcoat/clearcoatRoughnessFactor",
             EXTENSION + "anisotropy/anisotropyStrength",
             EXTENSION + "iridescence/iridescenceFactor",
             EXTENSION + "sheen/sheenRoughnessFactor",
             EXTENSION + "diffuse_transmission/diffuseTransmissionFactor",
             "materials/3/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor",
             *(f"{base}/{i}" for i in range(3) for base in (
                 PBR + "baseColorFactor", MATERIAL + "emissiveFactor", LIGHT + "color",
                 EXTENSION + "volume/attenuationColor",
                 EXTENSION + "sheen/sheenColorFactor",
                 EXTENSION + "diffuse_transmission/diffuseTransmissionColorFactor",
                 "materials/3/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor"))]
    least_zero = ["materials/1/alphaCutoff", "cameras/1/orthographic/znear",
                  EXTENSION + "emissive_strength/emissiveStrength",
                  EXTENSION + "specular/specularColorFactor/1",
                  EXTENSION + "volume/thicknessFactor", EXTENSION + "dispersion/dispersion",
                  EXTENSION + "iridescence/iridescenceThicknessMinimum",
                  EXTENSION + "iridescence/iridescenceThicknessMaximum",
                  LIGHT + "intensity", LIGHT + "spot/innerConeAngle",
                  MATERIAL + "normalTexture/texCoord", "accessors/0/byteOffset",
                  "bufferViews/0/byteOffset", CHANNELS + "0/sampler",
                  PBR + "baseColorTexture/extensions/KHR_texture_transform/texCoord"]
    above_zero = ["cameras/0/perspective/aspectRatio", "cameras/0/perspective/yfov",
                  "cameras/0/perspective/znear", "cameras/0/perspective/zfar",
                  "cameras/1/orthographic/zfar", "bufferViews/0/byteLength",
                  "accessors/0/count", "accessors/14/sparse/count",
                  EXTENSION + "volume/attenuationDistance", LIGHT + "range",
                  LIGHT + "spot/outerConeAngle"]
    yield from ((place, (-0.001, 1.001)) for place in share)
    yield from ((place, (-1,)) for place in least_zero)
    yield from ((place, (0, -1)) for place in above_zero)
    yield from (("nodes/4/rotation/3", (1.5, -1.5)), (ior, (0.5, -1, 2e5)),
                ("bufferViews/0/byteStride", (0, 256)), (LIGHT + "spot/outerConeAngle", (2,)),
                (EXTENSION + "iridescence/iridescenceIor", (0.9, 2e5)))


# What is not shown.
SKIPPED = ("pbrSpecularGlossiness", "animations")

SCHEMA += [("VALUE_NOT_IN_RANGE" + "~" * any(word in place for word in SKIPPED), "is required",
            put(place, value)) for place, values in ranges() for value in values]

SEMANTIC = [
    ("ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", "the accessor has 4 elements",
     put("accessors/14/sparse/count", 5)),
    ("ASSET_MIN_VERSION_GREATER_THAN_VERSION", "at most the version",
     put("asset/minVersion", "2.1")),
    ("BUFFER_DATA_URI_MIME_TYPE_INVALID", "the media type is \"text/plain\"",
     lambda model: model.put("buffer", {"uri": data_uri("text/plain", bytes(model.binary))})),
    ("CAMERA_XMAG_YMAG_NEGATIVE", "a positive number is required",
     put("cameras/1/orthographic/xmag", -1)),
    ("CAMERA_XMAG_YMAG_ZERO", "is 0, half the picture",
     put("cameras/1/orthographic/ymag", 0)),
    ("CAMERA_YFOV_GEQUAL_PI", "less than pi", put("cameras/0/perspective/yfov", 3.2)),
    ("CAMERA_ZFAR_LEQUAL_ZNEAR", "more than znear", put("cameras/0/perspective/zfar", 0.1)),
    ("CAMERA_ZFAR_LEQUAL_ZNEAR", "more than znear", put("cameras/1/orthographic/znear", 10)),
    ("INVALID_EXTENSION_NAME_FORMAT", "is not supported", put("extensionsUsed/18", "magic")),
    ("KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES", "not below the outer one",
     put(LIGHT + "spot/innerConeAngle", 0.8)),
    ("KHR_MATERIALS_DISPERSION_NO_VOLUME", "spreads nothing", drop(EXTENSION + "volume")),
    ("KHR_MATERIALS_VOLUME_NO_TRANSMISSION", "no light enters",
     drop(EXTENSION + "transmission"), drop(EXTENSION + "diffuse_transmission")),
    ("MESH_INVALID_WEIGHTS_COUNT", "has 2 weights", put("meshes/0/weights", [1, 2])),
    ("MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", "has 0 morph targets",
     put("meshes/0/primitives/1", {"attributes": {"POSITION": POSITION}})),
    ("MESH_PRIMITIVE_INVALID_ATTRIBUTE", "no attribute that glTF knows",
     put(ATTRIBUTES + "NORMALS", NORMAL)),
    ("MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH", "1 sets of JOINTS and 0 of WEIGHTS",
     drop(ATTRIBUTES + "WEIGHTS_0")),
    ("MESH_PRIMITIVE_NO_POSITION", "has no POSITION",
     drop("meshes/1/primitives/0/attributes/POSITION")),
    ("MULTIPLE_EXTENSIONS", "not made to stand beside KHR_materials_unlit",
     put("materials/2/extensions/KHR_materials_ior", {"ior": 1.4})),
    ("NODE_MATRIX_NON_TRS", "the last row is (0, 0.5, 0, 1)", put("nodes/5/matrix/7", 0.5)),
    ("NODE_MATRIX_TRS", "one way is required", put("nodes/5/scale", [1, 1, 1])),
    ("NON_RELATIVE_URI", "scheme is \"http:\"", drop(MATERIAL + "normalTexture"),
     image("http://example.com/a.png")),
    ("NON_RELATIVE_URI", "an absolute path", drop(MATERIAL + "normalTexture"),
     image("/pictures/a.png")),
    ("NON_RELATIVE_URI", "scheme is \"https:\"",
     put("buffers", [{"byteLength": 5, "uri": "https://example.com/a.bin"}])),
    ("NON_RELATIVE_URI!", "scheme is \"https:\"", image("https://example.com/a.png")),
    ("NON_RELATIVE_URI!", "an absolute path", image("//example.com/a.png")),
    ("NON_RELATIVE_URI!", "are missing: their buffer is not there",
     put("buffer", {"uri": "http://example.com/a.bin"})),
    ("NON_REQUIRED_EXTENSION", "must be listed in extensionsRequired",
     put("extensionsUsed/18", "KHR_mesh_quantization")),
    ("ROTATION_NON_UNIT", "length is 0.99, 1 is required",
     put("nodes/8/rotation", [0, 0.594, 0, 0.792])),
    ("UNKNOWN_ASSET_MAJOR_VERSION", "version 2.0 is read", put("asset/version", "3.0")),
    ("UNKNOWN_ASSET_MINOR_VERSION", "read as 2.0", put("asset/version", "2.1")),
    ("UNUSED_EXTENSION_REQUIRED", "required but not listed",
     put("extensionsRequired/1", "KHR_mesh_quantization")),
]

LINK = [
    ("ACCESSOR_SMALL_BYTESTRIDE", "whose byteStride is 8", view_of(POSITION, "byteStride", 8)),
    ("ACCESSOR_TOO_LONG", "of a buffer view of 48 bytes", put("accessors/0/count", 5)),
    ("ACCESSOR_TOO_LONG", "of a buffer view of 4 bytes",
     put("accessors/14/sparse/indices/byteOffset", 2)),
    ("ACCESSOR_TOTAL_OFFSET_ALIGNMENT", "of the buffer, a multiple of 4",
     shift_view(SHIFTS, 0, 2)),
    ("ANIMATION_CHANNEL_TARGET_NODE_MATRIX", "has a matrix",
     put(CHANNELS + "0/target/node", 5)),
    ("ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS", "without morph targets",
     put(CHANNELS + "2/target/node", 8)),
    ("ANIMATION_DUPLICATE_TARGETS", "moves what channel 0 moves",
     put(CHANNELS + "1/target/path", "translation")),
    ("ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT", "SCALAR of FLOAT (5126)",
     put(SAMPLERS + "0/input", SHIFTS)),
    ("ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS", "at least 2 are required",
     put(SAMPLERS + "0/interpolation", "CUBICSPLINE"), put("accessors/10/count", 1)),
    ("ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT", "values for 2 key frames",
     put("accessors/11/count", 1)),
    ("ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT", "VEC4 is required",
     put(SAMPLERS + "1/output", SHIFTS)),
    ("BUFFER_MISSING_GLB_DATA", "no BIN chunk", chunks(lambda found: found[:1])),
    ("BUFFER_VIEW_TOO_LONG", "of a buffer of", put("bufferViews/0/byteLength", 10 ** 6)),
    ("INVALID_IBM_ACCESSOR_COUNT", "1 matrices for 2 joints", put("accessors/9/count", 1)),
    ("KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT", "stands in two mappings",
     put(PRIMITIVE + "extensions/KHR_materials_variants/mappings/1/variants/0", 0)),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", "VEC2 is required",
     put(ATTRIBUTES + "TEXCOORD_0", NORMAL)),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", "are not normalised",
     put("accessors/6/componentType", 5121)),
    ("MESH_PRIMITIVE_INCOMPATIBLE_MODE", "do not make whole primitives",
     put("accessors/7/count", 5)),
    ("MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", "SCALAR of UNSIGNED_BYTE (5121)",
     put(PRIMITIVE + "indices", BLENDS)),
    ("MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT", "3 elements, POSITION has 4",
     put("accessors/8/count", 3)),
    ("MESH_PRIMITIVE_NO_TANGENT_SPACE", "neither TANGENT nor a normal map",
     drop(ATTRIBUTES + "TANGENT"), drop(MATERIAL + "normalTexture")),
    ("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "needs TEXCOORD_1",
     put(EXTENSION + "sheen/sheenColorTexture/texCoord", 1)),
    ("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "needs TEXCOORD_3",
     put(PBR + "baseColorTexture/extensions/KHR_texture_transform/texCoord", 3)),
    ("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", "NORMAL has 3 elements",
     put("accessors/1/count", 3)),
    ("NODE_LOOP", "its own descendant", put("nodes/8/children", [0]),
     put("scenes/0/nodes", [2])),
    ("NODE_PARENT_OVERRIDE", "has two parents", put("nodes/0/children/6", 3)),
    ("NODE_SKINNED_MESH_WITHOUT_SKIN", "there is no skin", drop("nodes/1/skin")),
    ("NODE_SKIN_WITH_NON_SKINNED_MESH", "its mesh names no joints", put("nodes/8/skin", 0)),
    ("NODE_WEIGHTS_INVALID", "has 2 weights", put("nodes/1/weights", [0, 1])),
    ("SCENE_NON_ROOT_NODE", "a scene lists roots only", put("scenes/0/nodes/2", 3)),
    ("SKIN_IBM_INVALID_FORMAT", "MAT4 of FLOAT (5126)",
     put("skins/0/inverseBindMatrices", TURNS)),
    ("UNDECLARED_EXTENSION", "not listed in extensionsUsed",
     put("extensionsUsed/0", "ACME_lamps")),
    ("UNEXPECTED_EXTENSION_OBJECT", "has no meaning on a node",
     put("nodes/8/extensions", {"KHR_materials_ior": {}})),
    ("UNRESOLVED_REFERENCE", "there are 2 in meshes", put("nodes/8/mesh", 2)),
    ("UNRESOLVED_REFERENCE~", "no sampler of the animation", put(CHANNELS + "0/sampler", 3)),
    ("UNRESOLVED_REFERENCE", "there are 2 in lights",
     put("nodes/6/extensions/KHR_lights_punctual/light", 2)),
    ("UNSUPPORTED_EXTENSION", "is not supported", put("extensionsUsed/19", "ACME_magic")),
]

DATA = [
    ("ACCESSOR_ANIMATION_INPUT_NON_INCREASING", "times that rise", poke(TIMES, 0, "f", 1),
     put("accessors/10/min/0", 1)),
    ("ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION", "not of length 1",
     poke(TURNS, 4, "f", 0, 0, 0, 0.9)),
    ("ACCESSOR_INDEX_OOB", "the primitive has 4 vertices", poke(INDICES, 2, "H", 4)),
    ("ACCESSOR_INDEX_PRIMITIVE_RESTART", "the primitive has 4 vertices",
     poke(INDICES, 2, "H", 65535)),
    ("ACCESSOR_INDEX_TRIANGLE_DEGENERATE", "1 triangle without area",
     put("nodes/1/mesh", 1), drop("nodes/1/weights"), put("nodes/8/mesh", 0),
     put("nodes/8/weights", [0]), put("nodes/8/skin", 0), drop("nodes/1/skin"),
     put("meshes/1/primitives/0/indices", 15),
     lambda model: model.accessor("SCALAR", "B", [0, 1, 2, 1, 1, 3], 34963)),
    ("ACCESSOR_INVALID_FLOAT", "finite numbers are required",
     poke(NORMAL, 4, "f", float("nan"))),
    ("ACCESSOR_JOINTS_INDEX_OOB", "the skin has 2 joints", poke(JOINTS, 1, "B", 2)),
    ("ACCESSOR_SPARSE_INDEX_OOB", "the accessor has 4 elements",
     poke_view(14, b"\1\0\4\0")),
    ("ACCESSOR_SPARSE_INDICES_NON_INCREASING", "indices that rise",
     poke_view(14, b"\3\0\1\0")),
    ("BUFFER_BYTE_LENGTH_MISMATCH", "bytes are there", put("buffer", {"byteLength": 10 ** 5})),
    ("BUFFER_GLB_CHUNK_TOO_BIG", "bytes more than byteLength",
     chunks(lambda found: [found[0], (found[1][0], found[1][1] + bytes(4))])),
    ("IMAGE_DATA_INVALID", "cannot be decoded",
     image(data_uri("image/png", PICTURE[:40] + b"....." + PICTURE[45:]))),
    ("IMAGE_MIME_TYPE_INVALID", "the bytes are image/png, the file says image/jpeg",
     put("images/0/mimeType", "image/jpeg")),
    ("IMAGE_NON_ENABLED_MIME_TYPE", "image/webp needs an extension",
     drop(MATERIAL + "normalTexture"), image(data_uri("", b"RIFF\4\0\0\0WEBPVP8 "))),
    ("IMAGE_UNEXPECTED_EOS", "cannot be decoded", image(data_uri("image/png", PICTURE[:12]))),
    ("IMAGE_UNEXPECTED_EOS", "cannot be decoded",
     image(data_uri("image/jpeg", b"\xff\xd8\xff"))),
    ("IMAGE_UNRECOGNIZED_FORMAT!", "cannot be decoded",
     image(data_uri("", b"no picture at all"))),
    ("IMAGE_UNRECOGNIZED_FORMAT", "cannot be decoded", drop(MATERIAL + "normalTexture"),
     image(data_uri("", b"no picture at all"))),
]

GLB = [
    ("GLB_CHUNK_LENGTH_UNALIGNED", "a multiple of 4", header(12, 101)),
    ("GLB_CHUNK_TOO_BIG", "are left", header(12, 10 ** 6)),
    ("GLB_DUPLICATE_CHUNK", "a second JSON chunk", chunks(lambda found: found + found[:1])),
    ("GLB_DUPLICATE_CHUNK", "may only be the second", chunks(lambda found: found + found[1:])),
    ("GLB_EMPTY_CHUNK", "not valid JSON",
     chunks(lambda found: [(b"JSON", b"")] + found[1:])),
    ("GLB_EXTRA_DATA", "the rest is skipped", glb(lambda data: data + bytes(8))),
    ("GLB_INVALID_MAGIC", "\"glTF\" is required", glb(lambda data: b"glTf" + data[4:])),
    ("GLB_INVALID_VERSION", "version 1 of the container", header(4, 1)),
    ("GLB_LENGTH_MISMATCH", "the length is 1000000", header(8, 10 ** 6)),
    ("GLB_LENGTH_TOO_SMALL", "at least 20 is required", header(8, 16)),
    ("GLB_UNEXPECTED_BIN_CHUNK", "may only be the second",
     chunks(lambda found: [found[0], (b"ACME", b""), found[1]])),
    ("GLB_UNEXPECTED_END_OF_CHUNK_DATA", "the file has",
     glb(lambda data: data[:-8])),
    ("GLB_UNEXPECTED_END_OF_CHUNK_HEADER", "a chunk's header has 8",
     glb(lambda data: data[:8] + struct.pack("<I", len(data) + 4) + data[12:] + bytes(4))),
    ("GLB_UNEXPECTED_END_OF_HEADER", "a .glb's header has 12", glb(lambda data: data[:11])),
    ("GLB_UNEXPECTED_FIRST_CHUNK", "JSON (0x4e4f534a) is required",
     chunks(lambda found: found[::-1])),
    ("GLB_UNKNOWN_CHUNK_TYPE", "unknown type",
     chunks(lambda found: found + [(b"ACME", b"abcd")])),
]


FAULTS = SCHEMA + SEMANTIC + LINK + DATA + GLB
