/* SPDX-License-Identifier: Apache-2.0 */
/* glazing.h -- materials that are laminated panes (PARHELION_glazing). */
#pragma once
#include "scene/gltf/loader.h"

/* NULL: the material is none. What the pane does not show (colour, roughness, volume, coat) is
 * taken off the material. */
void glazing_build(GltfFile *file, const GltfValue *glazing, Material *material);
