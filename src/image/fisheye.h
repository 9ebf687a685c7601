/* SPDX-License-Identifier: Apache-2.0 */
/* fisheye.h -- the pictures of half the space that a fisheye makes: a direction for each place
 * in a circle.
 *
 * Frame    right and up of the picture's middle in units of the circle's radius, so that the
 *          circle is 1: 90 degrees from the line of sight. Directions have the camera's axes: x
 *          right, y up, the line of sight along -z.
 *            equidistant  the angle is the radius times 90 degrees. Radiance's -vta
 *            equisolid    twice the sine of half the angle is the radius times sqrt(2): equal
 *                         areas are equal solid angles
 * Source   K. Miyamoto, "Fish eye lens", J. Opt. Soc. Am. 54 (1964) 1060.
 * Threads  pure functions. HOT: no libm.
 */
#pragma once
#include "base/mathf.h"
#include "base/vec.h"

typedef enum Fisheye { FISHEYE_NONE, FISHEYE_EQUIDISTANT, FISHEYE_EQUISOLID } Fisheye;

static inline const char *fisheye_name(Fisheye kind) {
    return kind == FISHEYE_EQUISOLID ? "equisolid" : "equidistant";
}

/* Unit; right^2 + up^2 <= 1, equidistant <= 4. */
static inline Vec3 fisheye_direction(Fisheye kind, float right, float up) {
    float square = right * right + up * up, radius = sqrtf(square);
    float sine, cosine, per_radius;
    if (kind == FISHEYE_EQUISOLID) {
        cosine = 1 - square; /* 1 - 2 sin^2 of half the angle */
        per_radius = safe_sqrtf(2 - square);
    } else {
        sincos_turns(0.25f * radius, &sine, &cosine);
        per_radius = radius > 1e-4f ? sine / radius : 1.57079633f;
    }
    return vec3_normalize(vec3(right * per_radius, up * per_radius, -cosine));
}
