/* SPDX-License-Identifier: Apache-2.0 */
/* animation_target.h -- what a channel of an animation moves.
 *
 * A property of a node, named by the channel itself (glTF 2.0, 3.11) or by a JSON pointer
 * (KHR_animation_pointer): "/nodes/N/translation", rotation, scale, weights, and
 * "/nodes/N/extensions/KHR_node_visibility/visible". Others can be named, but are not played.
 *
 * Threads  const data.
 */
#pragma once
#include "scene/gltf/tree.h"

typedef enum AnimationPath {
    MOVES_TRANSLATION,
    MOVES_ROTATION,
    MOVES_SCALE,
    MOVES_WEIGHTS,
    MOVES_VISIBLE,
    MOVES_COUNT
} AnimationPath;

typedef struct AnimationTarget {
    int node; /* of the document */
    AnimationPath path;
} AnimationTarget;

/* As messages call them. */
extern const char *const animation_path_names[MOVES_COUNT];

/* False where the channel moves nothing that is played. The document need not have been
 * checked. */
bool animation_target(const GltfValue *root, const GltfValue *channel, AnimationTarget *out);

/* The pointer or the path that a channel moves, for messages. */
const char *animation_target_text(const GltfValue *channel);
