/* SPDX-License-Identifier: Apache-2.0 */
/* opening.h -- points of a luminous opening, as they are seen from somewhere.
 *
 * Frame    the luminaire's. Threads: const.
 */
#pragma once
#include "spectrum/luminous_opening.h"

/* A point of the opening, wherever it is seen from; u in [0,1)^4. Over u the mean of
 *     opening_share(point, from) I(d) / r^2
 * is the illuminance as below. */
typedef struct OpeningPoint {
    Vec3 at;     /* m */
    Vec3 normal; /* of the unit body, on the opening's own axes; unset of what is flat */
    float drawn; /* density of its choice by the unit body's area; 0: it gives no light */
} OpeningPoint;

OpeningPoint opening_point(const LuminousOpening *opening, const float u[4]);
float opening_share(const LuminousOpening *opening, const OpeningPoint *point, Vec3 from);

/* A point of the opening for a receiver at `from`, u in [0,1)^2. Over u the mean of
 *     weight I(d) / r^2,   d and r from the point to `from`,
 * is the illuminance, lx, on a surface there that faces each point. The weight is 1 on what is
 * flat, 0 of a point that does not face `from`. */
Vec3 opening_sample(const LuminousOpening *opening, Vec3 from, const float u[2], float *weight);

/* From the origin to the farthest point, m. */
static inline float opening_radius(const LuminousOpening *opening) {
    const float *h = opening->half;
    return sqrtf(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
}
