/* SPDX-License-Identifier: Apache-2.0 */
/* icc_read.h -- the light that codes mean, by an ICC profile of a matrix and curves, or by
 * primaries and one curve.
 *
 * Source   ICC.1:2022. The profile's light is that of D50, which Bradford's matrix takes to
 *          D65.
 * Memory   curves point into the profile's bytes. Threads: pure functions.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "image/colour.h"

/* (a x + b)^gamma + e from d on, c x + f below; or a table. */
typedef struct CodeCurve {
    double gamma, a, b, c, d, e, f;
    const unsigned char *table; /* big-endian 16-bit numbers; NULL: none */
    uint32_t count;
} CodeCurve;

typedef struct IccLight {
    ColourMatrix rec709; /* from the light of the picture's own primaries */
    CodeCurve curve[3];
} IccLight;

/* False for profiles of other kinds and damaged ones. */
bool icc_read(const unsigned char *bytes, size_t size, IccLight *out);

/* The profile's name in ASCII, "without a name" where it has none. */
const char *icc_name(const unsigned char *bytes, size_t size, Arena *arena);

/* x, y of red, green, blue and white; light = code^gamma, or sRGB's curve for gamma 0. */
IccLight icc_light_of(const double chromaticities[8], double gamma);

/* 0 .. 1 for 0 .. 1. */
double code_curve_at(const CodeCurve *curve, double code);

/* As sRGB has them, within what 8 bits can show. */
bool icc_light_is_srgb(const IccLight *light);
