/* SPDX-License-Identifier: Apache-2.0 */
/* check_graph.h -- rules that tables cannot express, on nodes, meshes and skins. */
#pragma once
#include "scene/check/check.h"

void check_node(const DocumentCheck *check, const GltfValue *node);
void check_instancing(const DocumentCheck *check, const GltfValue *extension);
void check_mesh(const DocumentCheck *check, const GltfValue *mesh);
void check_skin(const DocumentCheck *check, const GltfValue *skin);
/* The whole document, after its objects: one parent at most, and no cycles. */
void check_hierarchy(const DocumentCheck *check, const GltfValue *root);
