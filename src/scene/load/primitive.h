/* SPDX-License-Identifier: Apache-2.0 */
/* primitive.h -- one primitive of one node becomes a part. */
#pragma once
#include "scene/gltf/loader.h"

void primitive_build(GltfFile *file, const GltfValue *node, const Transform *world,
                     const GltfValue *mesh, const GltfValue *primitive);
