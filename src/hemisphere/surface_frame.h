/* SPDX-License-Identifier: Apache-2.0 */
/* surface_frame.h -- hemisphere coordinates in which a reflection's lobe stands still that
 * belongs to the surface: brushed metal, a film with a structure.
 *
 * Such a lobe follows the light, but its axes do not turn with it. It depends on
 *     slopes      s = (wi + wo)_xy / (wi + wo)_z, of the facet that mirrors wi into wo, or
 *     cosines     b = (wi + wo)_xy, where roughness is fine (Harvey),
 * both 0 in the mirror direction. x = axes s makes the lobe round and about 1 wide (the axes
 * are a symmetric matrix). With c = asinh |x| / asinh reach, and c1 that of the horizon along
 * the same ray, the stored direction has the azimuth of x and the polar angle
 *     90 deg (c + (1 - c1) (c / c1)^4):
 * even near the peak, so many cells for each power of two further out, and the horizon stays
 * the horizon: what happens there for light from all sides happens in one place.
 *
 * Frame     wi and wo are unit vectors, +z up, in the frame in which the axes are; z of both
 *           above 0.
 * Threads   pure functions. HOT: no libm.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"

/* A symmetric 2 x 2 matrix. */
typedef struct SurfaceAxes {
    float xx, xy, yy;
} SurfaceAxes;

typedef struct SurfaceFrame {
    SurfaceAxes axes, inverse; /* inverse: of the axes */
    float scale;               /* 1 / asinh reach */
    bool is_cosine;
} SurfaceFrame;

/* axes: positive definite; reach: the longest x there is, above 0. */
SurfaceFrame surface_frame(bool is_cosine, SurfaceAxes axes, float reach);

Vec3 surface_frame_stored(const SurfaceFrame *frame, Vec3 wi, Vec3 wo);

/* The wo of a stored direction; one that rounding puts below the horizon is put on it. */
Vec3 surface_frame_leaving(const SurfaceFrame *frame, Vec3 wi, Vec3 stored);

/* The direction into which a facet mirrors wi that mirrors `light` into wo; z may be below
 * 0. */
Vec3 surface_frame_same_facet(Vec3 light, Vec3 wo, Vec3 wi);
