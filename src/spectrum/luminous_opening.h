/* SPDX-License-Identifier: Apache-2.0 */
/* luminous_opening.h -- the body or flat area out of which a luminaire shines.
 *
 * A box, an elliptic cylinder or an ellipsoid about the origin of the luminaire's frame
 * (intensity_web.h), each flat where one of its sizes is 0. It is as bright all over: with A(d)
 * the area that it shows towards d, its luminance that way is I(d) / A(d), so that from afar it
 * is the measured intensity. Of a flat one every piece of area sends out I(d) / area.
 *
 * Stretching maps the unit body (half sizes 1) to it. A piece of surface with normal n becomes
 * a vector area of cof(M) n, M = diag(half), so that n . cof(M) d is what it shows towards d.
 *
 * Units    metres. Threads: const.
 */
#pragma once
#include <stdbool.h>

#include "base/mathf.h"
#include "base/units.h"
#include "base/vec.h"

typedef enum OpeningShape {
    OPENING_POINT,
    OPENING_BOX,
    OPENING_CYLINDER,
    OPENING_ELLIPSOID
} OpeningShape;

typedef struct LuminousOpening {
    OpeningShape shape;
    int axis;      /* a cylinder's, or of what is flat its normal: 0 X, 1 Y, 2 Z */
    bool is_flat;  /* half[axis] is 0 */
    float half[3]; /* half sizes along X, Y, Z */
} LuminousOpening;

/* To and from the opening's own axes: z is `axis`, x and y follow it in turn. */
static inline Vec3 opening_turned(const LuminousOpening *opening, Vec3 v) {
    const float p[3] = {v.x, v.y, v.z};
    int axis = opening->axis;
    return vec3(p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]);
}

static inline Vec3 opening_turned_back(const LuminousOpening *opening, Vec3 v) {
    float p[3];
    int axis = opening->axis;
    p[(axis + 1) % 3] = v.x;
    p[(axis + 2) % 3] = v.y;
    p[axis] = v.z;
    return vec3(p[0], p[1], p[2]);
}

/* Half sizes on its own axes. */
static inline Vec3 opening_half(const LuminousOpening *opening) {
    return opening_turned(opening, vec3(opening->half[0], opening->half[1], opening->half[2]));
}

/* cof(M) d, on its own axes. */
static inline Vec3 opening_stretched(Vec3 half, Vec3 d) {
    return vec3(half.y * half.z * d.x, half.z * half.x * d.y, half.x * half.y * d.z);
}

/* The area that the unit body shows towards e, times the length of e. */
static inline float opening_unit_area(OpeningShape shape, Vec3 e) {
    switch (shape) {
    case OPENING_BOX: return 4 * (fabsf(e.x) + fabsf(e.y) + fabsf(e.z));
    case OPENING_CYLINDER: return PI_F * fabsf(e.z) + 4 * sqrtf(e.x * e.x + e.y * e.y);
    case OPENING_ELLIPSOID: return PI_F * vec3_length(e);
    case OPENING_POINT: break;
    }
    return 0;
}

/* m^2 that the opening shows towards the unit direction d. */
static inline float opening_area(const LuminousOpening *opening, Vec3 d) {
    return opening_unit_area(opening->shape,
                             opening_stretched(opening_half(opening), opening_turned(opening, d)));
}
