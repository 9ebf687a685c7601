/* SPDX-License-Identifier: Apache-2.0 */
/* pixel_errors.h -- metrics of the difference between two pictures of one size.
 *
 * Pictures must be finite: the caller has looked for NaN and infinity first.
 * Masked pixels count for nothing; no pixel at all gives NaN.
 * Threads  pure functions.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "compare/metrics/planes.h"

typedef struct PixelErrors {
    double mae, mse; /* over R, G, B and pixels; cd m^-2 and its square, or fractions */
    double rel_mse;  /* mean of (t - r)^2 / (r^2 + e^2): e is a hundredth of the reference's
                        mean luminance, so that black pixels do not decide. Infinite where a
                        black reference is compared with something else */
    double max_difference;
    double psnr_db;    /* 10 log10(peak^2 / mse); infinite for equal pictures, -infinite for a
                          reference without light */
    double peak;       /* that psnr_db was made with: 1 for pictures; for frames the
                          reference's 99.9th percentile of luminance (a sun in view does not
                          make every frame alike) */
    double mean_shift; /* mean luminance of the test over the reference's, minus 1; 0 when
                         both are black, infinite when only the reference is */
} PixelErrors;

/* Sums over pixels, one after the other, so that a picture that is added in pieces from its
 * top gives the same bits as one that is added whole. */
typedef struct PixelErrorSums {
    double luminance[2], members; /* reference, test; pixels */
    double floor;                 /* e of rel_mse */
    double mae, mse, rel_mse, max_difference, values;
} PixelErrorSums;

/* First of all pixels the means, then of all pixels the differences, which need them. Pixels
 * [first, end) of both. */
void pixel_errors_add_means(PixelErrorSums *sums, const Planes *reference, const Planes *test,
                            PixelMask mask, size_t first, size_t end);
void pixel_errors_add_differences(PixelErrorSums *sums, const Planes *reference, const Planes *test,
                                  PixelMask mask, size_t first, size_t end);
PixelErrors pixel_errors_of(const PixelErrorSums *sums, double peak);

/* is_light: the planes are cd m^-2. */
PixelErrors pixel_errors_measure(const Planes *reference, const Planes *test, PixelMask mask,
                                 bool is_light, Arena scratch);
