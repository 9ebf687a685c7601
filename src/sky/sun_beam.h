/* SPDX-License-Identifier: Apache-2.0 */
/* sun_beam.h -- the sun's direct light along its way through the layered air, above the horizon
 * and, for an observer in the air, below the horizontal.
 *
 * Straight rays from the sun's apparent place, as atmosphere.h has them; refraction has only
 * lifted that place. Water vapour thins exponentially over 2 km. The transmittances are
 * SPECTRL2's (spectrl2.h) of the amounts that lie along the ray.
 *
 * Units    metres, radians, lx, W m^-2 (300..4000 nm). Threads: a pure function. Fails: never.
 */
#pragma once
#include "sky/air/air.h"

#define SUN_BEAM_WATER_SCALE_M 2000.0

typedef struct SunBeamPath {
    double observer_m, floor_m; /* above the sea */
    double elevation;           /* of the ray, not below the floor's edge */
} SunBeamPath;

typedef struct SunBeam {
    double air_mass;  /* air along the ray over that straight above the observer */
    double lux, w_m2; /* on a plane that faces the sun, of its whole disc */
} SunBeam;

/* air: at sea level. */
SunBeam sun_beam(const Air *air, const SunBeamPath *path, double distance_au);
