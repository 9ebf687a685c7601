/* SPDX-License-Identifier: Apache-2.0 */
/* bent_ray.h -- a ray of sunlight that the air bends, and what lies along it.
 *
 * In spherical shells x = n r carries the ray: x times the sine of its angle to the zenith is
 * constant (Bouguer), so that along it ds = x dr / sqrt(x^2 - p^2) with p that constant, and it
 * turns by dn / n times p / sqrt(x^2 - p^2). The air's refractive index is 1 + 2.778e-4 at
 * 550 nm in the standard atmosphere at sea level (Ciddor 1996) and goes with its density.
 *
 * Units     metres, radians. Memory: the arena's, about 250 kB. Threads: const once built.
 * Fails     never.
 */
#pragma once
#include "base/arena.h"
#include "sky/air/air.h"

typedef struct BentAir {
    const AirOptics *optics;
    int count;                /* of nodes, evenly from sea level to the top */
    double *above[AIR_PARTS]; /* share of the column over a node */
    double *radius;           /* n r */
} BentAir;

BentAir bent_air_build(const AirOptics *optics, Arena *arena);

/* Cosine of the zenith angle at which a ray that grazes the floor is seen from an altitude. */
double bent_ray_edge_cosine(const BentAir *air, double altitude_m, double floor_m);

/* Columns from an altitude to space along a ray that is seen there at an angle of this cosine
 * to the zenith, and how far it turns on its way: outside the air it stands so much lower. The
 * cosine is that of the floor's edge at least. */
double bent_ray_column(const BentAir *air, double altitude_m, double cosine,
                       double column[AIR_PARTS]);
