/* SPDX-License-Identifier: Apache-2.0 */
/* furnace_fixture.h -- what a surface sends back under a uniform surround of 1. */
#pragma once
#include "shader_fixture.h"

#include "base/units.h"
#include "shaders/bsdf.h"

/* Points a side: of narrow lobes under a coat, which no two directions of a lobe pass alike, 48
 * show some 0.3 % amiss by themselves. */
static inline int furnace_side(const MetallicRoughness *m) {
    return m->clearcoat > 0 && m->alpha > 0 && m->alpha < 0.03f ? 144 : 48;
}

/* The samples run evenly, by a lattice, through u0 (the choices, and in each the turn) and
 * through sqrt(1 - u1) (facets that graze or lose their light crowd where u1 nears 1). */
static inline double furnace_of(const MetallicRoughness *m, double theta_deg, double phi_deg,
                                int side) {
    enum { TURNS = 8 }; /* for one height */
    double t = radians_from_degrees(theta_deg), p = radians_from_degrees(phi_deg), sum = 0;
    bool is_frosted = m->transmission > 0 && m->alpha > 0; /* u2 chooses there */
    Bsdf bsdf = {.kind = BSDF_METALLIC_ROUGHNESS, .metallic_roughness = *m};
    Vec3 wo = vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
    BsdfRoom room;
    bsdf_look(&bsdf, wo, &room);
    for (int i = 0; i < side * side * TURNS; i++) {
        int turn = i % (side * TURNS), height = i / (side * TURNS);
        double rest = (height + 0.5) / side, shift = fmod(height * 0.5698402910, 1);
        const float u[3] = {(float)((turn + shift) / (side * TURNS)), (float)(1 - rest * rest),
                            is_frosted ? (float)fmod(turn * 0.7548776662 + shift, 1) : 0.5f};
        BsdfSample s;
        if (bsdf_sample(&bsdf, wo, u, &s)) sum += 2 * rest * (double)s.weight[7];
    }
    return sum / (side * side * TURNS);
}
