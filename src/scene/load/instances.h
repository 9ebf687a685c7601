/* SPDX-License-Identifier: Apache-2.0 */
/* instances.h -- the places in which a node's mesh stands (EXT_mesh_gpu_instancing).
 *
 * Source   github.com/KhronosGroup/glTF, extensions/2.0/Vendor/EXT_mesh_gpu_instancing
 * Memory   places lie in the loader's scratch.
 * Fails    into the loader's problems, where bytes are missing: then there are none.
 * Threads  one at a time.
 */
#pragma once
#include "scene/gltf/loader.h"

typedef struct Instances {
    Transform *world_from_mesh;
    int count;
} Instances;

/* One, at `world`, unless the node states others. The document has passed the check. */
Instances instances_of(GltfFile *file, const GltfValue *node, const Transform *world);
