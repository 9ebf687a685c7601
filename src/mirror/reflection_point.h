/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_point.h -- where on a triangle does light from one direction turn towards a point?
 *
 * The triangle is flat, its mirror normal is the interpolated one: none, one or some points of
 * it can do so, and all of them are found. No chance is in it.
 *
 * Units    metres, scene; spread without unit.
 * Threads  pure functions.
 */
#pragma once
#include "base/vec.h"

typedef struct MirrorTriangle {
    Vec3 position[3]; /* m */
    Vec3 normal[3];   /* any length; of either side */
} MirrorTriangle;

typedef struct ReflectionPoint {
    float u, v;   /* barycentric weights of corners 1 and 2 */
    float spread; /* solid angle seen from the point by solid angle of the light's directions:
                     1 of a flat mirror, below of a convex one */
} ReflectionPoint;

#define REFLECTION_POINTS_MAX 9 /* two cubic curves meet no more often (Bezout) */

/* `from`: the point that is lit, off the triangle's plane; `towards`: unit, to the light.
 * Returns the number of points in the triangle. Two points that are about to become one,
 * nearer than 2^-16 of the triangle to each other, are left out: they carry less than that
 * share of its light. */
int reflection_points_find(const MirrorTriangle *triangle, Vec3 from, Vec3 towards,
                           ReflectionPoint out[REFLECTION_POINTS_MAX]);

/* ---- rough mirrors: facets lean from the normal, by slopes along a frame of the triangle - */

/* The triangle of facets that lean so: their normals are the interpolated ones plus slope.x and
 * slope.y of the axes of a frame about the corners' mean normal. */
MirrorTriangle reflection_leaning(const MirrorTriangle *triangle, Vec2 slope);

/* At a point of the leaning triangle: solid angle seen from `from` by area of slopes. */
float reflection_slope_spread(const MirrorTriangle *triangle, Vec3 from, Vec3 towards,
                              const ReflectionPoint *at);
