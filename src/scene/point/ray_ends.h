/* SPDX-License-Identifier: Apache-2.0 */
/* ray_ends.h -- a point of a triangle: where a ray that leaves it starts, and where one that
 * goes to it ends.
 *
 * One rule for all rays. A computed point lies beside its triangle by rounding, and so does the
 * triangle's plane as the ray tracer computes it. Bounds of both, u = 2^-24, p the point, n the
 * normal, L the triangle's longest edge, s the product of its two shorter edges over twice its
 * area (1 for half a square, more for slivers), D the distance from the ray's other end:
 *
 *   point      p = a + (u e1 + v e2): one rounding of the sum, u |n|.|p|, and those of the
 *              edges, below 4 u L; as much again as the first where the start is moved off it.
 *   plane      the ray tracer takes corners relative to the ray's origin and their normal by
 *              a cross product: each is off by a few u times (L + D), the normal by s.
 *
 * A small triangle may lie in the plane of a large one (a decal, a key), which is off by its
 * own L: L is at least that of the scene's largest triangle or 4 m, whichever is less.
 *
 * With r = u |n|.|p| + 4 u (1 + s) (L + D) a ray starts 2 r off its triangle, and ends as far
 * before the one that it goes to (after M. Pharr, W. Jakob and G. Humphreys, "Physically Based
 * Rendering", 3rd edition, 6.8).
 *
 * Where two triangles meet at an angle, a point beside the edge may lie behind the other
 * triangle: rays start and end RAY_INSET steps from their triangle's edges at least. That keeps
 * edges closed down to 29 degrees: h / tan(29 degrees) + h / sin(29 degrees) = 3.9 h. Besides,
 * the ray tracer misses triangles whose edge a ray nearly follows: it compares the volume that
 * edge and ray span, L d sin(angle) at a distance d, with some u L^2. Rays so close to an edge
 * are the rarer, by 1 / d^2, the farther they start off it: RAY_INSET_SHARE of L more, of 1 m
 * at most, since light is sampled there instead. (In closed boxes no path of dull bounces was
 * seen to get out; of rays at angles evenly down to 0.006 degrees, by decades, one in 10^6 did
 * without that.)
 *
 * Units    m, scene.
 * Threads  pure functions.
 */
#pragma once
#include "base/mathf.h"
#include "bvh/ray.h"
#include "scene/scene.h"

/* A point of a triangle, interpolated. */
typedef struct TrianglePoint {
    Vec3 position;
    Vec3 ng; /* unit, the front's side (counter-clockwise vertices) */
    Vec3 ns; /* unit, interpolated vertex normal; ng where that vanishes */
    Vec2 uv[SCENE_UV_SETS];
    float u, v;     /* barycentric weights of vertices 1 and 2 */
    Vec3 inside;    /* m: where rays start and end: a little off the edges */
    float rounding; /* m, along ng: of the point and of its plane, seen from nearby; */
    float slant;    /* and what each metre adds from where it is seen */
} TrianglePoint;

TrianglePoint triangle_point(const Scene *scene, uint32_t triangle, float u, float v);

/* Its position alone. */
Vec3 triangle_position(const Scene *scene, uint32_t triangle, float u, float v);

#define RAY_STEP 2.0f
#define RAY_INSET 4.0f
#define RAY_INSET_SHARE 0x1p-14f

/* How far rays start off the point's triangle, m. Sheets within it are at the same place. */
static inline float ray_step(const TrianglePoint *point) {
    return RAY_STEP * point->rounding;
}

/* How far from the edges of its triangle, whose longest one is given, m. */
static inline float ray_inset(const TrianglePoint *point, float longest) {
    return RAY_INSET * ray_step(point) + RAY_INSET_SHARE * min_f(longest, 1);
}

/* Where a ray starts that leaves the point to the side of `towards`. */
static inline Vec3 ray_start(const TrianglePoint *point, Vec3 towards) {
    float step = ray_step(point);
    return vec3_along(point->inside, point->ng, vec3_dot(point->ng, towards) < 0 ? -step : step);
}

/* From a start to just before the point, which it meets on the side of `side`. */
static inline Ray ray_to(Vec3 from, const TrianglePoint *point, Vec3 side) {
    float reach = vec3_length(vec3_sub(point->inside, from));
    float step = RAY_STEP * (point->rounding + point->slant * reach);
    Vec3 end = vec3_along(point->inside, point->ng, vec3_dot(point->ng, side) < 0 ? -step : step);
    Vec3 way = vec3_sub(end, from);
    float length = vec3_length(way);
    return (Ray){from, vec3_normalize(way), 0, length};
}

/* What is left of a ray behind the triangle that it met. */
static inline Ray ray_behind(const Scene *scene, Ray ray, const Hit *hit) {
    TrianglePoint point = triangle_point(scene, hit->triangle, hit->u, hit->v);
    return (Ray){ray_start(&point, ray.direction), ray.direction, 0, max_f(ray.t_max - hit->t, 0)};
}
