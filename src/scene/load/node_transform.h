/* SPDX-License-Identifier: Apache-2.0 */
/* node_transform.h -- a place from a matrix, or from a translation, a rotation and a scale
 * (glTF 2.0, 3.5.3).
 *
 * Units    m. Fails never. Threads: no state.
 */
#pragma once
#include <math.h>

#include "base/vec.h"

/* Column by column; the last row is (0, 0, 0, 1). */
static inline Transform transform_from_matrix(const float m[16]) {
    return (Transform){vec3(m[0], m[1], m[2]), vec3(m[4], m[5], m[6]), vec3(m[8], m[9], m[10]),
                       vec3(m[12], m[13], m[14])};
}

/* T R S; q = (x, y, z, w) is a unit quaternion to within rounding: it is normalised here. */
static inline Transform transform_from_trs(const float t[3], const float q[4], const float s[3]) {
    float n = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    float k = n > 0 ? 1 / n : 0;
    float x = q[0] * k, y = q[1] * k, z = q[2] * k, w = n > 0 ? q[3] * k : 1.0f;
    Vec3 a = vec3(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y));
    Vec3 b = vec3(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x));
    Vec3 c = vec3(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y));
    return (Transform){vec3_scale(a, s[0]), vec3_scale(b, s[1]), vec3_scale(c, s[2]),
                       vec3(t[0], t[1], t[2])};
}
