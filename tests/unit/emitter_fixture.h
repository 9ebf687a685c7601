/* SPDX-License-Identifier: Apache-2.0 */
/* emitter_fixture.h -- densities of emitters' points in one measure. */
#pragma once
#include "light/emitters.h"

/* m^-2, of the point as seen from `from`. */
static inline double density_on_area(const Scene *scene, EmitterPoint at, Vec3 from,
                                     EmitterDensity density) {
    TrianglePoint point = triangle_point(scene, at.triangle, at.u, at.v);
    Vec3 d = vec3_sub(from, point.position);
    double d2 = (double)vec3_dot(d, d);
    double cosine = fabs((double)vec3_dot(point.ng, d)) / sqrt(d2);
    return (double)density.on_area + (double)density.on_sphere * cosine / d2;
}
