/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_point.h -- where on a triangle does light turn towards a point?
 *
 * The light comes from one direction or from a point. The triangle is flat, its mirror normal is
 * the interpolated one: none, one or some points of it can do so, and all of them are found. No
 * chance is in it.
 *
 * Units    metres, scene.
 * Threads  pure functions.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"

typedef struct MirrorTriangle {
    Vec3 position[3]; /* m */
    Vec3 normal[3];   /* any length; of either side */
} MirrorTriangle;

typedef struct ReflectionLight {
    Vec3 at; /* is_near: where it is, m; else unit, towards it */
    bool is_near;
} ReflectionLight;

typedef struct ReflectionPoint {
    float u, v;   /* barycentric weights of corners 1 and 2 */
    float spread; /* of a light far away: solid angle seen from the point by solid angle of the
                     light's directions, 1 of a flat mirror, below of a convex one. Of a near
                     one m^-2, the lux on what faces the mirror there by a candela: of a flat one
                     1 over the squared length of the whole way */
} ReflectionPoint;

#define REFLECTION_POINTS_MAX 16 /* two quartic curves meet no more often (Bezout) */

/* `from`: the point that is lit, and a near light, off the triangle's plane, on one side of it.
 * Returns the number of points in the triangle. Two points that are about to become one,
 * nearer than 2^-16 of the triangle to each other, are left out: they carry less than that
 * share of its light. */
int reflection_points_find(const MirrorTriangle *triangle, Vec3 from, const ReflectionLight *light,
                           ReflectionPoint out[REFLECTION_POINTS_MAX]);

/* The spread at a point of it, m, that is known to turn the light. */
float reflection_spread(const MirrorTriangle *triangle, Vec3 from, const ReflectionLight *light,
                        Vec3 point);

/* ---- rough mirrors: facets lean from the normal, by slopes along a frame of the triangle - */

/* The triangle of facets that lean so: their normals are the interpolated ones plus slope.x and
 * slope.y of the axes of a frame about the corners' mean normal. */
MirrorTriangle reflection_leaning(const MirrorTriangle *triangle, Vec2 slope);

/* At a point of the leaning triangle: solid angle seen from `from` by area of slopes. */
float reflection_slope_spread(const MirrorTriangle *triangle, Vec3 from,
                              const ReflectionLight *light, const ReflectionPoint *at);
