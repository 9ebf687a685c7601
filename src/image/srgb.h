/* SPDX-License-Identifier: Apache-2.0 */
/* srgb.h -- the transfer function of sRGB, both ways (IEC 61966-2-1).
 *
 * Units    codes and display-referred linear light, both in [0, 1].
 * Threads  pure functions.
 *
 * In single precision with our own power (base/mathf.h), so that the bits are the same
 * everywhere; in double precision with the C library's, for charts, which only people look at.
 */
#pragma once
#include <math.h>

#include "base/mathf.h"

static inline float srgb_from_linear(float light) {
    return light <= 0.0031308f ? 12.92f * light : 1.055f * pow_f(light, 1 / 2.4f) - 0.055f;
}

static inline float linear_from_srgb(float code) {
    return code <= 0.04045f ? code / 12.92f : pow_f((code + 0.055f) / 1.055f, 2.4f);
}

/* The same for every texel that is looked up: products in place of quotients round a little
 * differently, and frames keep their bits. */
static inline float linear_from_srgb_texel(float code) {
    return code <= 0.04045f ? code * (1 / 12.92f) : pow_f((code + 0.055f) * (1 / 1.055f), 2.4f);
}

static inline double linear_from_srgb_d(double code) {
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}
