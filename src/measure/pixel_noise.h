/* SPDX-License-Identifier: Apache-2.0 */
/* pixel_noise.h -- the noise of means over pixels, added up pixel by pixel.
 *
 * Units    linear Rec.709 and luminance, cd m^-2; variances are their squares.
 * Threads  pure functions.
 */
#pragma once
#include <stdbool.h>

#define SIGMAS_95 1.959964 /* of the normal distribution */

/* Variances of sums over pixels, of channels and of luminance. */
typedef struct PixelNoise {
    double rgb[3], luminance, fourths; /* fourths: squares of the pixels' variances */
    long pixels;
} PixelNoise;

/* What chance does to the parts that pixels have of a display: the sum of spread (mean - R)^2
 * for any R (display_part.h), of R, G, B and luminance. */
typedef struct RimNoise {
    double spread, means[4], squares[4];
} RimNoise;

/* Variances of one pixel. */
void pixel_noise_add(PixelNoise *noise, const double rgb[3], double luminance);

/* Greatest variance of the luminance that those of R, G and B allow. */
double pixel_noise_luminance(const double variance[3]);

/* Halves' squares are those of normal variables, as many as count: 3 (sum d^2)^2 / sum d^4.
 * Student's factor is put into the variances. False where they are fewer than `least`, or some
 * of the pixels have none. */
bool pixel_noise_of_halves(const PixelNoise *halves, long pixels, double least, PixelNoise *out);

/* A pixel's spread and its mean. */
void rim_noise_add(RimNoise *rim, double spread, const double rgb[3]);

/* Adds it to `to` for means `rgb` over all parts. */
void rim_noise_put(const RimNoise *rim, const double rgb[3], PixelNoise *to);
