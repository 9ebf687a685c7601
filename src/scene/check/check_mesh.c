/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_mesh.h"

#include <string.h>

#include "base/number.h"
#include "scene/check/check_material.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"

/* The formats that an attribute may have. Component types as bits: 1 << (code - 5120). */
typedef struct Format {
    const char *prefix; /* "TEXCOORD_": a number follows; "POSITION": the whole name */
    const char *types;
    unsigned components, quantized; /* the latter with KHR_mesh_quantization */
    bool is_normalized;             /* integers must be */
} Format;

enum { MOST_ATTRIBUTES = 256 }; /* pairs of them are compared */

enum { BYTE = 1, UBYTE = 2, SHORT = 4, USHORT = 8, FLOATS = 64 };

static const Format FORMATS[] = {
    {"POSITION", "VEC3", FLOATS, FLOATS | BYTE | UBYTE | SHORT | USHORT, false},
    {"NORMAL", "VEC3", FLOATS, FLOATS | BYTE | SHORT, true},
    {"TANGENT", "VEC4", FLOATS, FLOATS | BYTE | SHORT, true},
    {"TEXCOORD_", "VEC2", FLOATS | UBYTE | USHORT, FLOATS | BYTE | UBYTE | SHORT | USHORT, false},
    {"COLOR_", "VEC3|VEC4", FLOATS | UBYTE | USHORT, FLOATS | UBYTE | USHORT, true},
    {"JOINTS_", "VEC4", UBYTE | USHORT, UBYTE | USHORT, false},
    {"WEIGHTS_", "VEC4", FLOATS | UBYTE | USHORT, FLOATS | UBYTE | USHORT, true},
};

/* The number behind the prefix; -1 when the name does not match. A whole name gives 0. */
static int match(const Format *format, const char *name) {
    size_t length = strlen(format->prefix);
    if (strncmp(name, format->prefix, length) != 0) return -1;
    const char *rest = name + length;
    if (format->prefix[length - 1] != '_') return rest[0] ? -1 : 0;
    uint64_t number;
    const char *end = number_read_count(rest, &number);
    return !end || *end || end - rest > 4 || (*rest == '0' && end - rest > 1) ? -1 : (int)number;
}

static const Format *format_of(const char *name) {
    for (size_t i = 0; i < sizeof FORMATS / sizeof *FORMATS; i++)
        if (match(&FORMATS[i], name) >= 0) return &FORMATS[i];
    return NULL;
}

static bool is_type(const char *types, const char *type) {
    return strcmp(types, type) == 0 || (strcmp(types, "VEC3|VEC4") == 0 &&
                                        (strcmp(type, "VEC3") == 0 || strcmp(type, "VEC4") == 0));
}

/* Displacements have no sign for a bitangent and may be signed integers throughout. */
static void check_format(const DocumentCheck *check, const GltfValue *attribute, bool is_target) {
    const Format *format = format_of(attribute->key);
    const GltfValue *accessor = tree_referred(attribute, "accessors");
    if (!accessor) return;
    int code = tree_int(accessor, "componentType", 0);
    unsigned bit = code >= 5120 && code <= 5126 ? 1u << (code - 5120) : 0;
    const char *type = tree_text(accessor, "type", "");
    if (!format) {
        if (attribute->key[0] != '_')
            check_warns(check, attribute, "\"%.60s\" is no attribute that glTF knows",
                        attribute->key);
        return;
    }
    bool is_quantized = document_uses(check->file, "KHR_mesh_quantization");
    unsigned allowed = is_quantized ? format->quantized : format->components;
    const char *types = is_target && format->types[3] == '4' ? "VEC3" : format->types;
    if (is_target) allowed |= BYTE | SHORT;
    if (!is_type(types, type) || !(bit & allowed))
        check_fails(check, attribute,
                    "%s is %s of component type %s, which glTF does not allow "
                    "(%s is required)",
                    attribute->key, type, component_name(code), types);
    else if (format->is_normalized && bit != FLOATS && !tree_boolean(accessor, "normalized", false))
        check_fails(check, attribute, "%s is made of integers that are not normalised",
                    attribute->key);
}

static void check_count(const DocumentCheck *check, const GltfValue *attribute, double wanted) {
    double count = tree_number(tree_referred(attribute, "accessors"), "count", wanted);
    if (wanted >= 0 && count != wanted)
        check_fails(check, attribute, "%s has %.0f elements, POSITION has %.0f", attribute->key,
                    count, wanted);
}

/* JOINTS_1 without WEIGHTS_1 ... */
static void check_joints(const DocumentCheck *check, const GltfValue *attributes) {
    int sets[2] = {0, 0};
    for (int i = 0; i < attributes->count; i++) {
        sets[0] += match(&FORMATS[5], attributes->items[i].key) >= 0;
        sets[1] += match(&FORMATS[6], attributes->items[i].key) >= 0;
    }
    if (sets[0] != sets[1])
        check_warns(check, attributes, "%d sets of JOINTS and %d of WEIGHTS", sets[0], sets[1]);
}

static void check_indices(const DocumentCheck *check, const GltfValue *indices) {
    const GltfValue *accessor = tree_referred(indices, "accessors");
    int code = tree_int(accessor, "componentType", 0);
    bool is_unsigned = code == 5121 || code == 5123 || code == 5125;
    if (!accessor) return;
    if (strcmp(tree_text(accessor, "type", ""), "SCALAR") != 0 || !is_unsigned)
        check_fails(check, indices,
                    "are %s of component type %s, SCALAR of %s, %s or %s is required",
                    tree_text(accessor, "type", "?"), component_name(code), component_name(5121),
                    component_name(5123), component_name(5125));
    else if (tree_boolean(accessor, "normalized", false))
        check_fails(check, indices, "are normalised, which indices cannot be");
}

static void check_displacement(const DocumentCheck *check, const GltfValue *attribute,
                               double count) {
    if (!tree_referred(attribute, "accessors"))
        check_fails(check, attribute, "an index into accessors is required");
    check_format(check, attribute, true);
    check_count(check, attribute, count);
}

static void check_targets(const DocumentCheck *check, const GltfValue *primitive, double count) {
    const GltfValue *targets = tree_member(primitive, "targets");
    if (!targets) return;
    if (targets->kind != GLTF_ARRAY || !targets->count) {
        check_fails(check, targets, "an array of morph targets is required");
        return;
    }
    for (int t = 0; t < targets->count; t++) {
        const GltfValue *target = &targets->items[t];
        if (target->kind != GLTF_OBJECT || !target->count) {
            check_fails(check, target, "an object of attributes is required");
            continue;
        }
        for (int i = 0; i < target->count; i++) check_displacement(check, &target->items[i], count);
    }
}

static void check_mode(const DocumentCheck *check, const GltfValue *primitive, double vertices) {
    static const int LEAST[] = {1, 2, 2, 2, 3, 3, 3};
    int mode = tree_int(primitive, "mode", 4);
    const GltfValue *accessor = tree_referred(tree_member(primitive, "indices"), "accessors");
    double count = tree_number(accessor, "count", vertices);
    if (mode < 0 || mode > 6 || count < 0) return;
    bool is_odd = (mode == 4 && fmod(count, 3) != 0) || (mode == 1 && fmod(count, 2) != 0);
    if (count < LEAST[mode] || is_odd)
        check_warns(check, primitive, "%.0f corners do not make whole primitives of mode %d", count,
                    mode);
}

/* Microsoft Flight Simulator's packing: a mesh's primitives share all vertices and indices. */
static void check_slice(const DocumentCheck *check, const GltfValue *primitive) {
    const GltfValue *slice = tree_member(tree_member(primitive, "extras"), "ASOBO_primitive");
    const GltfValue *indices = tree_referred(tree_member(primitive, "indices"), "accessors");
    double corners = tree_number(indices, "count", 0);
    if (slice && (tree_number(slice, "StartIndex", 0) != 0 ||
                  tree_number(slice, "BaseVertexIndex", 0) != 0 ||
                  3 * tree_number(slice, "PrimitiveCount", corners / 3) != corners))
        check_warns(check, slice,
                    "is a slice of shared vertices and indices, as Microsoft Flight Simulator "
                    "packs them, which is not read: all of them are shown, and the picture is "
                    "not the simulator's; take the model as it was before packing");
}

void check_primitive(const DocumentCheck *check, const GltfValue *primitive) {
    const GltfValue *attributes = tree_member(primitive, "attributes");
    const GltfValue *indices = tree_member(primitive, "indices");
    if (!attributes || attributes->kind != GLTF_OBJECT) return;
    if (attributes->count > MOST_ATTRIBUTES) {
        check_fails(check, attributes, "has %d attributes, at most %d are read", attributes->count,
                    MOST_ATTRIBUTES);
        return;
    }
    const GltfValue *position = tree_member(attributes, "POSITION");
    double count = tree_number(tree_referred(position, "accessors"), "count", -1);
    if (!position) check_warns(check, attributes, "has no POSITION: the primitive is skipped");
    for (int i = 0; i < attributes->count; i++) {
        check_format(check, &attributes->items[i], false);
        check_count(check, &attributes->items[i], count);
    }
    check_joints(check, attributes);
    check_slice(check, primitive);
    check_material_fits(check, primitive);
    if (indices) check_indices(check, indices);
    check_mode(check, primitive, count);
    check_targets(check, primitive, count);
}
