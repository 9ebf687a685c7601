/* SPDX-License-Identifier: Apache-2.0 */
/* check_vertices.h -- the numbers at vertices: unit vectors, colours, weights.
 *
 * What is off is corrected while the scene is built (vectors are normalised, colours clamped,
 * weights divided by their sum), so that it only warns: once an attribute, with its first
 * place.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Checks every primitive of a document whose structure and accessors passed. */
void check_vertices(GltfFile *file);
