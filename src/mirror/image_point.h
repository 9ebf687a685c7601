/* SPDX-License-Identifier: Apache-2.0 */
/* image_point.h -- where on a triangle does light from one point turn towards another?
 *
 * As reflection_point.h, but for a source that is near: the triangle is flat, its mirror normal
 * is the interpolated one. In a plane mirror the point lies on the straight line to the source
 * mirrored at the plane; from there Newton's steps lead to where the interpolated normal turns
 * the light. No chance is in it.
 *
 * Approximate  of a triangle that is bent so much that it shows the source more than once, one
 *              of the points is found.
 * Units    metres.
 * Threads  pure functions.
 */
#pragma once
#include "mirror/reflection_point.h"

typedef struct ImagePoint {
    float u, v;    /* barycentric weights of corners 1 and 2 */
    Vec3 position; /* m */
} ImagePoint;

/* from: the eye; source: the point that it sees in the mirror, on the same side of the
 * triangle's plane. False: there is no such point in the triangle. */
bool image_point_find(const MirrorTriangle *triangle, Vec3 from, Vec3 source, ImagePoint *out);
