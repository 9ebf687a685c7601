/* SPDX-License-Identifier: Apache-2.0 */
/* ray.h -- a ray, and where it met a triangle. Metres, world space. */
#pragma once
#include <stdint.h>

#include "base/vec.h"

typedef struct Ray {
    Vec3  origin;
    Vec3  direction; /* unit */
    float t_min;     /* m, >= 0 */
    float t_max;     /* m; INFINITY: no end */
} Ray;

typedef struct Hit {
    float    t;        /* m */
    float    u, v;     /* barycentric weights of vertices 1 and 2 */
    uint32_t triangle; /* index into Scene.triangles */
} Hit;

/* The cone around a ray that a frame's pixel covers: its width across the ray, m, is `width`
 * at the ray's origin and grows by `spread` a metre. Both 0: the ray is of no frame. */
typedef struct RayCone {
    float width, spread;
} RayCone;

/* How far a ray starts off the surface that it leaves, m: 2^-17 of the largest coordinate, ten
 * times the rounding of a point computed from barycentric weights. */
static inline float ray_offset_step(Vec3 position)
{
    float size = fmaxf(fmaxf(fabsf(position.x), fabsf(position.y)), fabsf(position.z));
    return fmaxf(size, 1e-3f) * 0x1p-17f;
}

/* Moves a surface point off its triangle by that, to the side of `towards`. */
static inline Vec3 ray_offset_origin(Vec3 position, Vec3 ng, Vec3 towards)
{
    float step = ray_offset_step(position);
    return vec3_along(position, ng, vec3_dot(ng, towards) < 0 ? -step : step);
}
