/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/animation_target.h"

#include <limits.h>
#include <string.h>

#include "base/number.h"

#define EXTENSION "KHR_animation_pointer"
#define NODES "/nodes/"
#define VISIBLE "extensions/KHR_node_visibility/visible"

const char *const animation_path_names[MOVES_COUNT] = {[MOVES_TRANSLATION] = "translation",
                                                       [MOVES_ROTATION] = "rotation",
                                                       [MOVES_SCALE] = "scale",
                                                       [MOVES_WEIGHTS] = "weights",
                                                       [MOVES_VISIBLE] = "visible"};

static bool find_path(const char *name, AnimationPath *out) {
    for (int i = 0; i < MOVES_VISIBLE; i++) {
        if (strcmp(animation_path_names[i], name) != 0) continue;
        *out = (AnimationPath)i;
        return true;
    }
    return false;
}

/* The number at *text, which is moved behind it and the slash; -1: there is none. */
static int take_index(const char **text) {
    uint64_t index;
    const char *end = number_read_count(*text, &index);
    if (!end || *end != '/' || index > INT_MAX || (end - *text > 1 && **text == '0')) return -1;
    *text = end + 1;
    return (int)index;
}

/* Only a node that has the extension can be shown and hidden. */
static bool find_pointed(const GltfValue *root, const char *pointer, AnimationTarget *out) {
    if (strncmp(pointer, NODES, strlen(NODES)) != 0) return false;
    pointer += strlen(NODES);
    out->node = take_index(&pointer);
    const GltfValue *node = tree_element(root, "nodes", out->node);
    if (!node) return false;
    if (strcmp(pointer, VISIBLE) != 0) return find_path(pointer, &out->path);
    out->path = MOVES_VISIBLE;
    return tree_extension(node, "KHR_node_visibility") != NULL;
}

bool animation_target(const GltfValue *root, const GltfValue *channel, AnimationTarget *out) {
    const GltfValue *target = tree_member(channel, "target");
    const GltfValue *pointer = tree_extension(target, EXTENSION);
    if (pointer) return find_pointed(root, tree_text(pointer, "pointer", ""), out);
    out->node = tree_int(target, "node", -1);
    return tree_element(root, "nodes", out->node) &&
           find_path(tree_text(target, "path", ""), &out->path);
}

const char *animation_target_text(const GltfValue *channel) {
    const GltfValue *target = tree_member(channel, "target");
    const char *path = tree_text(target, "path", "");
    return tree_text(tree_extension(target, EXTENSION), "pointer", path);
}
