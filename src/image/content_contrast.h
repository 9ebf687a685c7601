/* SPDX-License-Identifier: Apache-2.0 */
/* content_contrast.h -- the contrast of what a picture shows: characters on their ground.
 *
 * The pixels' luminances are split where the two halves differ most from each other and least
 * in themselves (Otsu, IEEE Trans. SMC 9 (1979) 62); the smaller half is the characters. A
 * pixel beside one of the other half may be covered in part: where enough others are left,
 * each half is the mean of those alone. What the greatest and the least half percent hold (a
 * firefly) does not move the split: characters have to fill more of the region than that.
 *
 * Not answered, with the reason, where a split would be made of noise or of a slope: when the
 * halves explain less than 0.8 of the variance that is not noise (a slope: 0.75, noise that is
 * not known: 0.64, two luminances: 1), or lie less than 6 standard errors of a pixel from each
 * other, where some pixels would be counted to the wrong half.
 *
 * Units    luminance in cd m^-2. Intervals: 95 %, of the noise that the variances state.
 * Memory   scratch only.  Threads  pure functions.  Fails  never.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"

/* A figure and its interval, of which both ends are NaN without variances. */
typedef struct Measured {
    double value, low, high;
} Measured;

static inline Measured measured_about(double value, double half_width) {
    return (Measured){value, value - half_width, value + half_width};
}

static inline double measured_half_width(Measured figure) {
    return 0.5 * (figure.high - figure.low);
}

/* Rows of pixels; NaN: not part of the region. */
typedef struct ContentPixels {
    int width, height;
    const float *luminance; /* cd m^-2 */
    const float *variance;  /* of luminance, (cd m^-2)^2; NULL: not known */
} ContentPixels;

typedef enum ContentVerdict {
    CONTENT_FOUND,
    CONTENT_TOO_SMALL, /* fewer than 16 pixels, or all of one luminance */
    CONTENT_NOT_TWO,   /* a slope, or one luminance and noise that is not known */
    CONTENT_NOISY      /* one, or two too near each other for this noise */
} ContentVerdict;

typedef struct ContentContrast {
    ContentVerdict verdict;
    double separability; /* the share of the variance, less the noise's, that the split
                            explains */
    double threshold;    /* cd m^-2 */
    double noise_sigmas; /* the halves' distance; NaN without variances */
    /* the rest where the verdict is CONTENT_FOUND */
    long character_pixels, ground_pixels; /* of each half */
    bool edges_left_out;                  /* the figures are of pixels inside the halves */
    Measured characters, ground;
    Measured ratio;     /* brighter / darker */
    Measured michelson; /* (brighter - darker) / (brighter + darker) */
    Measured weber;     /* (characters - ground) / ground; below 0: dark on bright */
} ContentContrast;

ContentContrast content_contrast(const ContentPixels *pixels, Arena scratch);
