/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: points of an emitter that is near. No allocation, no lock, no libm. */
#include "light/solid_angle.h"

#include "base/mathf.h"
#include "base/units.h"

/* tan(value / 2) = volume / (1 + A.B + B.C + C.A) for unit vectors A, B, C (van Oosterom and
 * Strackee 1983). The volume from differences, which small triangles need. */
SolidAngle solid_angle_of(const Vec3 corner[3]) {
    SolidAngle seen = {.value = 0};
    for (int k = 0; k < 3; k++) {
        seen.distance[k] = vec3_length(corner[k]);
        if (!(seen.distance[k] > 0)) return seen;
        seen.corner[k] = vec3_scale(corner[k], 1 / seen.distance[k]);
    }
    Vec3 a = seen.corner[0], b = seen.corner[1], c = seen.corner[2];
    Vec3 across = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    float below = 1 + vec3_dot(a, b) + vec3_dot(b, c) + vec3_dot(c, a);
    seen.volume = fabsf(vec3_dot(a, across));
    seen.value = 2 * atan2_f(seen.volume, below);
    return seen;
}

/* How far the arc from A to C is followed, so that the triangle A, B, C' has the share u0.
 *
 * C' = A cos p + E sin p, where E is what C has across A, made unit: C = A cos b + E sin b. The
 * formula above for A, B, C', with T = tan(u0 value / 2), reads
 *     T ((1 + A.B) (1 + cos p) + sin p B.E) = sin p det(A, B, E),
 * and is linear in tan(p / 2) = sin p / (1 + cos p):
 *     tan(p / 2) = T (1 + A.B) / (det(A, B, E) - T B.E).
 * Both sides of the fraction are multiplied by sin b and cos(u0 value / 2), so that nothing is
 * infinite; det(A, B, E) sin b is the volume. */
static void turn_along(const SolidAngle *seen, float u0, Vec3 e, float sin_b, float *sine,
                       float *cosine) {
    Vec3 a = seen->corner[0], b = seen->corner[1];
    float s, c, a_b = vec3_dot(a, b);
    sincos_turns(u0 * seen->value * (0.25f / PI_F), &s, &c);
    float over = s * (1 + a_b) * sin_b;
    float under = c * seen->volume - s * vec3_dot(vec3_along(b, a, -a_b), e);
    float squares = over * over + under * under;
    float inverse = squares > 0 ? 1 / squares : 0;
    *sine = 2 * over * under * inverse;
    *cosine = squares > 0 ? (under - over) * (under + over) * inverse : 1;
}

/* Arvo 1995: C' on the arc from A to C splits off the share u0 of the solid angle; on the arc
 * from B to C' the share u1 of the lune lies where 1 - cos grows to u1 of its whole. Each step
 * mixes two corners with weights that are known, so no ray has to be cut with the plane. */
void solid_angle_sample(const SolidAngle *seen, float u0, float u1, float weight[3]) {
    Vec3 a = seen->corner[0], b = seen->corner[1], c = seen->corner[2];
    float cos_b = vec3_dot(a, c), sine, cosine;
    Vec3 e = vec3_along(c, a, -cos_b); /* of length sin b */
    float sin_b = vec3_length(e);
    turn_along(seen, u0, e, sin_b, &sine, &cosine);
    float of_c = sin_b > 0 ? sine / sin_b : 0;
    Vec3 split = vec3_along(vec3_scale(a, cosine), e, of_c);
    Vec3 chord = vec3_sub(split, b);
    float whole = 0.5f * vec3_dot(chord, chord), part = u1 * whole; /* 1 - cos */
    float of_split = whole > 0 ? sqrtf(u1 * (2 - part) / (2 - min_f(whole, 1.999999f))) : 0;
    weight[0] = of_split * (cosine - of_c * cos_b);
    weight[1] = (1 - part) - (1 - whole) * of_split;
    weight[2] = of_split * of_c;
    float sum = 0;
    for (int k = 0; k < 3; k++) {
        weight[k] = max_f(weight[k], 0) / seen->distance[k];
        sum += weight[k];
    }
    for (int k = 0; k < 3; k++) weight[k] = sum > 0 ? weight[k] / sum : k == 1;
}
