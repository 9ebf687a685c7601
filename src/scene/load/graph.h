/* SPDX-License-Identifier: Apache-2.0 */
/* graph.h -- the tree of nodes, flattened into the scene. */
#pragma once
#include "scene/gltf/loader.h"

/* Walks the nodes that are shown, in order; adds parts, lights and cameras. After nodes_place,
 * and when the scene's origin is known. */
void graph_build(GltfFile *file);
