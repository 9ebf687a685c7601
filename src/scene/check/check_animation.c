/* SPDX-License-Identifier: Apache-2.0 */
/* At rest faults of animations only warn; when they are played (--time), those fail that leave
 * open where something stands. */
#include "scene/check/check_animation.h"

#include <string.h>

#include "scene/gltf/accessor.h"
#include "scene/gltf/animation_target.h"

#define BYTE_CODE 5121
#define FLOAT_CODE 5126

/* The format of the values of a path. */
typedef struct ChannelPath {
    const char *type;
    bool may_be_integer; /* normalised */
} ChannelPath;

static const ChannelPath PATHS[MOVES_COUNT] = {[MOVES_TRANSLATION] = {"VEC3", false},
                                               [MOVES_ROTATION] = {"VEC4", true},
                                               [MOVES_SCALE] = {"VEC3", false},
                                               [MOVES_WEIGHTS] = {"SCALAR", true},
                                               [MOVES_VISIBLE] = {"SCALAR", false}};

static const GltfValue *accessor_of(const GltfValue *sampler, const char *name) {
    return tree_referred(tree_member(sampler, name), "accessors");
}

static void check_sampler(const DocumentCheck *check, const GltfValue *sampler) {
    const GltfValue *input = accessor_of(sampler, "input");
    bool is_cubic = strcmp(tree_text(sampler, "interpolation", "LINEAR"), "CUBICSPLINE") == 0;
    if (input && (strcmp(tree_text(input, "type", ""), "SCALAR") != 0 ||
                  tree_int(input, "componentType", 0) != FLOAT_CODE))
        check_fails(
            check, sampler, "the times are %s of component type %s, SCALAR of %s is required",
            tree_text(input, "type", "?"), component_name(tree_int(input, "componentType", 0)),
            component_name(FLOAT_CODE));
    if (input && is_cubic && tree_number(input, "count", 2) < 2)
        check_warns(check, sampler, "a cubic spline has %g key frame, at least 2 are required",
                    tree_number(input, "count", 2));
}

static int morph_targets(const GltfValue *node) {
    const GltfValue *mesh = tree_referred(tree_member(node, "mesh"), "meshes");
    return tree_count(tree_item(tree_member(mesh, "primitives"), 0), "targets");
}

/* KHR_animation_pointer allows every type of component, and requires bytes where something is
 * shown or not; glTF itself floats, or integers that are normalised. */
static bool is_component(const GltfValue *output, AnimationPath path, bool is_pointed) {
    int code = tree_int(output, "componentType", FLOAT_CODE);
    bool is_normalized = tree_boolean(output, "normalized", false);
    if (path == MOVES_VISIBLE) return code == BYTE_CODE && !is_normalized;
    return code == FLOAT_CODE || is_pointed || (PATHS[path].may_be_integer && is_normalized);
}

/* values: how many a key frame has; 0: it matters not. */
static void check_output(const DocumentCheck *check, const GltfValue *channel,
                         const GltfValue *sampler, AnimationPath path, int values) {
    const GltfValue *input = accessor_of(sampler, "input");
    const GltfValue *output = accessor_of(sampler, "output");
    const char *how = tree_text(sampler, "interpolation", "LINEAR");
    const char *name = animation_path_names[path], *type = PATHS[path].type;
    bool is_cubic = strcmp(how, "CUBICSPLINE") == 0;
    bool is_pointed = tree_extension(tree_member(channel, "target"), "KHR_animation_pointer");
    if (!input || !output) return;
    if (strcmp(tree_text(output, "type", ""), type) != 0 || !is_component(output, path, is_pointed))
        check_fails(check, channel,
                    "the values of a %s are %s of component type %s, %s is required", name,
                    tree_text(output, "type", "?"),
                    component_name(tree_int(output, "componentType", FLOAT_CODE)), type);
    if (path == MOVES_VISIBLE && strcmp(how, "STEP") != 0)
        check_fails(check, channel, "the interpolation of visible is %.20s, STEP is required", how);
    double wanted = tree_number(input, "count", 0) * (is_cubic ? 3 : 1) * values;
    if (values && tree_number(output, "count", 0) != wanted)
        check_fails(check, channel, "%g values for %g key frames, %g are required",
                    tree_number(output, "count", 0), tree_number(input, "count", 0), wanted);
}

/* Reports a channel that is not played; an error where the file requires that it is. */
static void check_unplayed(const DocumentCheck *check, const GltfValue *channel) {
    const GltfValue *target = tree_member(channel, "target");
    bool is_pointed = tree_extension(target, "KHR_animation_pointer");
    if (!check->file->load->options->state.has_time) return;
    if (tree_member(target, "node") && !is_pointed &&
        !tree_referred(tree_member(target, "node"), "nodes"))
        return; /* reported by the table */
    const GltfValue *required = tree_member(check->file->root, "extensionsRequired");
    DocumentCheck milder = {check->file, SEVERITY_WARNING};
    if (is_pointed && tree_lists(required, "KHR_animation_pointer"))
        milder.severity = check->severity;
    check_fails(&milder, channel,
                "moves \"%.100s\", which is not played: only nodes, their morph weights and "
                "their visibility are",
                animation_target_text(channel));
}

static void check_channel(const DocumentCheck *check, const GltfValue *animation,
                          const GltfValue *channel) {
    AnimationTarget moved;
    const GltfValue *target = tree_member(channel, "target");
    const GltfValue *sampler =
        tree_item(tree_member(animation, "samplers"), tree_int(channel, "sampler", NO_ID));
    if (!sampler) {
        check_fails(check, channel, "refers to no sampler of the animation");
        return;
    }
    if (!animation_target(check->file->root, channel, &moved)) {
        check_unplayed(check, channel);
        return;
    }
    const GltfValue *node = tree_element(check->file->root, "nodes", moved.node);
    if (moved.path <= MOVES_SCALE && tree_member(node, "matrix"))
        check_fails(check, target, "moves a node that has a matrix");
    int targets = morph_targets(node);
    if (moved.path == MOVES_WEIGHTS && !targets)
        check_warns(check, target, "moves morph weights of a node without morph targets");
    check_output(check, channel, sampler, moved.path, moved.path == MOVES_WEIGHTS ? targets : 1);
}

/* glTF 2.0, 3.11: a property of a node moves in one way at most. */
static void check_targets(const DocumentCheck *check, const GltfValue *channels) {
    const GltfValue *root = check->file->root;
    AnimationTarget own, other;
    for (int i = 1; channels && i < channels->count; i++) {
        if (!animation_target(root, &channels->items[i], &own)) continue;
        for (int k = 0; k < i; k++) {
            if (!animation_target(root, &channels->items[k], &other) || other.node != own.node ||
                other.path != own.path)
                continue;
            check_fails(check, tree_member(&channels->items[i], "target"),
                        "moves what channel %d moves", k);
            break;
        }
    }
}

void check_animation(const DocumentCheck *check, const GltfValue *animation) {
    for (const GltfValue *s = tree_items(animation, "samplers"); s; s = tree_next(s))
        check_sampler(check, s);
    for (const GltfValue *c = tree_items(animation, "channels"); c; c = tree_next(c))
        check_channel(check, animation, c);
    check_targets(check, tree_member(animation, "channels"));
}
