/* SPDX-License-Identifier: Apache-2.0 */
/* nodes.h -- where the nodes of a file stand, and which of them are shown.
 *
 * Memory   in the loader's scratch.
 * Threads  one at a time.
 * Fails    into the loader's problems. That the nodes are a tree is checked before.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Where a node's mesh stands, in its frame: once, or as EXT_mesh_gpu_instancing has it. */
typedef struct NodeInstances {
    Transform *node_from_mesh; /* NULL: it stands where the node does, */
    int count;                 /* 1; 0: bytes are missing, which is reported */
} NodeInstances;

/* Sets the file's parents, its places in the world, posed by its animations, what is shown of
 * it (below the roots of its default scene, else of its first, else all), and the instances of
 * that. */
void nodes_place(GltfFile *file);

/* From the world to the scene, whose origin is known now: sets world_from_node. */
void nodes_enter_scene(GltfFile *file);

/* The place of a camera's node, unit axes: the scaling of it and of its parents is ignored
 * (glTF 2.0, 3.10.2). world: where the node stands, after changes of the scene. */
Transform nodes_camera_place(const GltfFile *file, const GltfValue *node, const Transform *world);

/* The place of an instance in the frame that the nodes' are in. */
NodePlace nodes_instance_place(const GltfFile *file, int node, int instance);
