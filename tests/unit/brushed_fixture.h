/* SPDX-License-Identifier: Apache-2.0 */
/* brushed_fixture.h -- tables of brushed solids for one pair of alphas. */
#pragma once
#include "shaders/facets/solid_energy.h"

static inline const SolidEnergy *brushed_energy(float ior, float along, float across,
                                                bool has_facets, Arena *arena) {
    float high = fmaxf(along, across), ratio = fminf(along, across) / high;
    return solid_energy_brushed(solid_energy_build(ior, across, across, has_facets, arena),
                                (BrushedRange){high, high, ratio, ratio}, arena);
}
