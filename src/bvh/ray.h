/* SPDX-License-Identifier: Apache-2.0 */
/* ray.h -- a ray, and where it met a triangle. Metres, scene coordinates. */
#pragma once
#include <stdint.h>

#include "base/vec.h"

typedef struct Ray {
    Vec3 origin;
    Vec3 direction; /* unit */
    float t_min;    /* m, >= 0 */
    float t_max;    /* m; INFINITY: no end */
} Ray;

typedef struct Hit {
    float t;           /* m */
    float u, v;        /* barycentric weights of vertices 1 and 2 */
    uint32_t triangle; /* index into Scene.triangles */
} Hit;
