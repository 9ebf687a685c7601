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

/* Moves a surface point off its triangle, to the side of `towards`: by 2^-17 of the largest
 * coordinate, ten times the rounding of a point computed from barycentric weights. */
static inline Vec3 ray_offset_origin(Vec3 position, Vec3 ng, Vec3 towards)
{
    float size = fmaxf(fmaxf(fabsf(position.x), fabsf(position.y)), fabsf(position.z));
    float step = fmaxf(size, 1e-3f) * 0x1p-17f;
    return vec3_along(position, ng, vec3_dot(ng, towards) < 0 ? -step : step);
}
