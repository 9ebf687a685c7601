/* SPDX-License-Identifier: Apache-2.0 */
/* colour.h -- changes between colour spaces that are given by their primaries.
 *
 * Units    linear light; no chromatic adaptation: a colour keeps its XYZ.
 * Threads  pure functions.
 */
#pragma once
#include <math.h>
#include <stdbool.h>

/* x, y of what has X, Y and Z for its primaries. */
static const double XYZ_CHROMATICITIES[8] = {1, 0, 0, 1, 0, 0, 1 / 3.0, 1 / 3.0};

/* Rows; out = m * in. */
typedef struct ColourMatrix {
    double m[3][3];
} ColourMatrix;

/* x, y of red, green, blue and white D65: ITU-R BT.709-6. */
static const double REC709_CHROMATICITIES[8] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};

/* All 0 for a singular matrix. */
ColourMatrix colour_inverse(const ColourMatrix *matrix);

/* First b, then a. */
ColourMatrix colour_product(const ColourMatrix *a, const ColourMatrix *b);

/* m = 0 for primaries on one line, which no light can be mixed from. */
ColourMatrix xyz_from_primaries(const double chromaticities[8]);

/* From RGB of the given primaries and white to linear Rec.709 of the same light. */
ColourMatrix rec709_from_primaries(const double chromaticities[8]);

/* False for primaries that no picture can have (not finite, on one line, white without y). */
bool chromaticities_are_usable(const double chromaticities[8]);

/* True within the 0.001 that files round to. */
bool chromaticities_are_rec709(const double chromaticities[8]);

static inline void colour_apply(const ColourMatrix *matrix, const float in[3], float out[3]) {
    float a = in[0], b = in[1], c = in[2];
    for (int i = 0; i < 3; i++)
        out[i] = (float)(matrix->m[i][0] * (double)a + matrix->m[i][1] * (double)b +
                         matrix->m[i][2] * (double)c);
}
