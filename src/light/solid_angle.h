/* SPDX-License-Identifier: Apache-2.0 */
/* solid_angle.h -- a triangle as a point sees it: a uniform choice among the directions to it.
 *
 * Units    solid angle in sr. Threads: plain values.
 */
#pragma once
#include "base/vec.h"

typedef struct SolidAngle {
    Vec3 corner[3];    /* unit, from the point to the corners */
    float distance[3]; /* m */
    float volume;      /* of the parallelepiped of the three, >= 0 */
    float value;       /* sr, 0 .. 2 pi; 0 when the point lies in the plane */
} SolidAngle;

/* corner: relative to the point, m. A corner at the point itself gives value 0. */
SolidAngle solid_angle_of(const Vec3 corner[3]);

/* Barycentric weights of a corner's part in the point of the triangle that lies in a direction
 * uniform in the solid angle; u0, u1 in [0,1). All >= 0, their sum 1. */
void solid_angle_sample(const SolidAngle *seen, float u0, float u1, float weight[3]);
