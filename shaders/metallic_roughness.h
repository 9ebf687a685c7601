/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_roughness.h -- glTF's surface: paint, plastic, cloth, leather, chrome, lacquer.
 *
 * The user page is on top of metallic_roughness.c. Frame and units: bsdf.h.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/metallic/metallic_view.h"

/* glTF's default material, but for energy, which the caller owns: white metal, alpha 1. */
MetallicRoughness metallic_roughness_default(const EnergyTable *energy);

extern const BsdfModel metallic_roughness_model;
