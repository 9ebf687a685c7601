/* SPDX-License-Identifier: Apache-2.0 */
/* sphere_light.h -- light that has been scattered more than once, in spherical air: for a sun
 * below the horizon, where flat layers (diffuse_light.h) lose it.
 *
 * In twilight the air overhead is lit by air beyond the Earth's shadow, hundreds of kilometres
 * towards the sun and tens of kilometres up. Successive orders of scattering are marched
 * through the sphere itself: the source of every order lies in tables over altitude and local
 * sun angle (spherical symmetry leaves no other place), each order's radiance is gathered along
 * straight rays from every node through those tables, and scattered again. Directions as
 * diffuse_light.h: 8 Gauss cosines a side, azimuth as a cosine series.
 *
 * Approximate  rays are straight; no polarisation; between places only three modes of azimuth
 *              travel; between two sun angles light falls exponentially.
 * Units     as diffuse_light.h, whose tables it fills.
 * Memory    the arena's, about 10 MB, and 50 MB while it builds. Threads: `threads` of them.
 * Fails     never.
 */
#pragma once
#include "sky/air/beam_table.h"
#include "sky/air/diffuse_light.h"

#define SPHERE_LEVELS 36

typedef struct SphereInput {
    const BeamTable *beam;
    double floor_albedo;
    double first_zenith, step; /* of the local sun angles, radians */
    int count;                 /* of them, at most SPHERE_ANGLES_MAX */
    int orders;                /* of scattering, at most; 0: all, the last as a series */
    int threads;
} SphereInput;

#define SPHERE_ANGLES_MAX 24

/* out: one for each sun angle. Gives the number of orders. */
int sphere_light_build(const SphereInput *input, Arena *arena, DiffuseLight *out);

/* Weights of two neighbouring sun angles at a share t of the way, for light that grows by
 * exp(rise) from the first to the second. */
void sphere_light_weights(float t, float rise, float weight[2]);
