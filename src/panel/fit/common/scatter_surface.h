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

/* The same of a table's channel, or of its logarithms: what its scattered rows show. */
double scatter_surface_table_noise(const AngleTable *table, int channel, bool in_logs,
                                   Arena scratch);

/* How far the surface may be off at a direction. */
typedef struct ScatterDoubt {
    double open;      /* of a surface of roughness 1 through the same samples */
    double roughness; /* what the samples around miss by as the others predict them, over it */
    double spread;    /* by how much the values around differ */
    double gap;       /* to the nearest sample, radians */
    bool is_between;  /* samples stand all round */
} ScatterDoubt;

/* Of the middle channel, at many directions. |p - q|^3 is a covariance; the values' own noise
 * is part of the roughness. */
void scatter_surface_doubt(const ScatterSurface *surface, const Vec3 *at, int count,
                           ScatterDoubt *out, Arena scratch);

/* A standard deviation: open * roughness, and no more than the values around differ by. */
double scatter_doubt_sigma(const ScatterDoubt *doubt);
