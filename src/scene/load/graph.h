/* SPDX-License-Identifier: Apache-2.0 */
/* graph.h -- the tree of nodes, flattened into the world. */
#pragma once
#include "scene/gltf/loader.h"

/* Walks the scene's nodes, in order; adds parts, lights and cameras. */
void graph_build(GltfFile *file);
