/* SPDX-License-Identifier: Apache-2.0 */
/* d3.h -- points and directions in double precision, for what single precision places badly.
 *
 * Units    metres, scene. Threads: pure functions. Fails: never.
 */
#pragma once
#include "base/vec.h"

typedef struct D3 {
    double x, y, z;
} D3;

static inline D3 d3_of(Vec3 a) {
    return (D3){(double)a.x, (double)a.y, (double)a.z};
}

static inline D3 d3_sub(D3 a, D3 b) {
    return (D3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline D3 d3_along(D3 a, D3 b, double s) {
    return (D3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline double d3_dot(D3 a, D3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline D3 d3_cross(D3 a, D3 b) {
    return (D3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
