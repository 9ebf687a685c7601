/* SPDX-License-Identifier: Apache-2.0 */
/* scatter_surface.h -- a smooth surface through values at scattered directions.
 *
 * A direction d is the point (d.x, d.y) / (1 + d.z) of the plane (stereographic: small circles
 * stay round). Through the points goes the sum of |p - q|^3 and a plane, the smoothest one in
 * the sense of thin plates (Duchon 1977; Wendland, Scattered Data Approximation, 2004, for
 * the conditions under which it exists and its order). More points than PATCH_MOST are halved
 * along the wider side of their box, again and again; the halves share rows on both sides of
 * the cut and pass into each other smoothly (partition of unity).
 *
 * Values may be noisy: the surface passes as far off them as makes the values most likely, the
 * noise and the surface taken for Gaussian (Wahba, Ann. Statist. 13, 1985, on such choices).
 *
 * Units    any values; directions of the upper hemisphere. Memory: the arena's. Threads: const
 *          once made. Fails: never; outside the points the surface goes on and means nothing.
 */
#pragma once
#include "base/arena.h"
#include "base/vec.h"
#include "panel/set/angle_table.h"

typedef struct ScatterSurface ScatterSurface;

/* value: rows x channels. mirrored: values at -phi are those at phi. */
const ScatterSurface *scatter_surface_make(const AngleTable *table, bool mirrored,
                                           const float *value, int channels, Arena *arena);

/* All channels at a direction. */
void scatter_surface_read(const ScatterSurface *surface, Vec3 at, float *out);

/* Standard deviation of the noise beside the surface, in the values' units. */
double scatter_surface_noise(const ScatterSurface *surface);
