/* SPDX-License-Identifier: Apache-2.0 */
/* icc_profile.h -- a small ICC profile that defines a picture's code values.
 *
 * Memory   the bytes come from the arena. Threads: a pure function. Fails: never.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"
#include "image/colour.h"

typedef enum IccCurve {
    ICC_CURVE_SRGB,   /* IEC 61966-2-1 */
    ICC_CURVE_GAMMA24 /* ITU-R BT.1886 with a black of 0 */
} IccCurve;

typedef struct IccProfile {
    const void *bytes;
    size_t size;
} IccProfile;

/* From RGB to XYZ, the white adapted to D50 by Bradford's matrix, as profiles have it. */
ColourMatrix icc_d50_from_primaries(const double chromaticities[8]);

/* ICC.1:2010 (version 4.3), class "display", matrix and curve. chromaticities: x, y of red,
 * green, blue and white; the white is adapted to D50 by Bradford's matrix, as the standard
 * requires. description: ASCII, at most 100 characters. */
IccProfile icc_profile_create(const double chromaticities[8], IccCurve curve,
                              const char *description, Arena *arena);
