/* SPDX-License-Identifier: Apache-2.0 */
/* measured_index.h -- the index of refraction of a material, by wavelength.
 *
 * KHR_materials_dispersion, and files that carry OpenMaterial_ior_data: JSON with n and k over
 * the wavelength in metres, at one or several temperatures; that nearest 293 K is taken.
 *
 * Source   github.com/LudwigFriedmann/OpenMATERIAL, glTF_extensions
 * Memory   in the loader's arena.
 * Fails    into the loader's problems, with the place in both files.
 */
#pragma once
#include "scene/gltf/loader.h"

/* The material has its other members; what is measured stands in for its ior. */
void measured_index_build(GltfFile *file, const GltfValue *material, Material *out);
