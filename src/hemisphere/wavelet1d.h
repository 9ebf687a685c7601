/* SPDX-License-Identifier: Apache-2.0 */
/* wavelet1d.h -- wavelet transforms of short rows of numbers, such as spectra.
 *
 * By lifting (Sweldens 1996), with mirrored boundaries, for any length. Every step halves the
 * approximation until one value is left. All kinds reproduce constants; CDF 5/3 keeps straight
 * lines out of the details, CDF 9/7 cubics (away from the ends).
 *
 * Layout    values[0] the coarsest approximation, then the details, coarsest first.
 * Scaling   biorthogonal, low-pass gain 1: values[0] of a constant row is the constant. Details
 *           are not normalised; wavelet1d_norms returns their norms.
 */
#pragma once
#include "base/arena.h"

typedef enum WaveletKind { WAVELET_HAAR = 0, WAVELET_CDF53 = 1, WAVELET_CDF97 = 2 } WaveletKind;

#define WAVELET_MAX_COUNT 1024

/* values: `count` floats, 1..WAVELET_MAX_COUNT, in place. */
void wavelet1d_forward(WaveletKind kind, float *values, int count);

/* Inverts exactly, to rounding. */
void wavelet1d_inverse(WaveletKind kind, float *values, int count);

/* norms[i]: the root of the sum of squares of what coefficient i = 1 alone inverts to. */
void wavelet1d_norms(WaveletKind kind, int count, float *norms);
