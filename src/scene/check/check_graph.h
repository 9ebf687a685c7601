/* SPDX-License-Identifier: Apache-2.0 */
/* check_graph.h -- what tables cannot say about nodes, meshes and skins. */
#pragma once
#include "scene/check/check.h"

void check_node(const DocumentCheck *check, const GltfValue *node);
void check_instancing(const DocumentCheck *check, const GltfValue *extension);
void check_mesh(const DocumentCheck *check, const GltfValue *mesh);
void check_skin(const DocumentCheck *check, const GltfValue *skin);
/* Of the whole document, after its objects: one parent at most, and no circles. */
void check_hierarchy(const DocumentCheck *check, const GltfValue *root);
