/* SPDX-License-Identifier: Apache-2.0 */
/* specular_frame.h -- hemisphere coordinates in which a reflection's peak stands still.
 *
 * The "distorted disk": light comes from azimuth 180 degrees (-x) at theta_i, so that the
 * mirror direction lies at azimuth 0. A direction (theta, phi) is the disk point
 *     U = theta/90deg (cos phi, sin phi), the mirror direction d0 = (theta_i/90deg, 0).
 * Write U = c e + (1-c) d0 with |e| = 1 and c in [0, 1]. The stored direction has the azimuth
 * of e and the polar angle 90deg c^(1/k): the peak is at the pole, the horizon stays the
 * horizon. k = 2 widens narrow peaks, k = 1 keeps wide haze small.
 *
 * Frame     "outer" is the display's frame turned so that the light is at -x; "stored" is the
 *           tree's frame. Both: +z up, unit vectors, z >= 0 (z < 0 counts as 0). Mirror
 *           images in y stay mirror images.
 * Speed     HOT: no libm.
 */
#pragma once
#include "base/vec.h"

typedef struct SpecularFrame {
    float offset;   /* |d0|, theta_i / 90deg */
    float exponent; /* k */
} SpecularFrame;

/* theta_i in radians, clamped to 0..89 degrees; k at least 1. */
SpecularFrame specular_frame(float theta_i, float k);

/* Outer direction to stored direction. At the mirror direction itself e = (1, 0). */
Vec3 specular_frame_stored(const SpecularFrame *frame, Vec3 outer);

/* Stored direction to outer direction. */
Vec3 specular_frame_outer(const SpecularFrame *frame, Vec3 stored);

/* d(solid angle outer) / d(solid angle stored) at a stored direction:
 * J = (sin to / to) / (sin tp / tp) * (1 - d0.e) * k * (tp/90deg)^(2k-2).
 * A density per stored solid angle is divided by J to be one per outer solid angle. For k > 1
 * J goes to 0 at the pole (the peak), where the outer density diverges integrably. */
float specular_frame_jacobian(const SpecularFrame *frame, Vec3 stored);

/* specular_frame_outer and specular_frame_jacobian at once, for a unit stored direction. */
Vec3 specular_frame_outer_jacobian(const SpecularFrame *frame, Vec3 stored, float *jacobian);

/* specular_frame_stored and the Jacobian at once, for a unit outer direction, in little more
 * time than the first alone. */
Vec3 specular_frame_stored_jacobian(const SpecularFrame *frame, Vec3 outer, float *jacobian);
