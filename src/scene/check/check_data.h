/* SPDX-License-Identifier: Apache-2.0 */
/* check_data.h -- the bytes behind the accessors: finite, within bounds, indices exist. */
#pragma once
#include "scene/gltf/loader.h"

/* Only of a document in which everything else is sound. */
void check_data(GltfFile *file);
