/* SPDX-License-Identifier: Apache-2.0 */
/* regression.h -- light as a linear function of features, in a window of pixels.
 *
 * Weighted first-order regression; a fit counts for every pixel of its window, not for the
 * middle alone (Bitterli et al. 2016, "collaborative").
 *
 * Threads  windows that do not overlap may be added at the same time.
 */
#pragma once
#include "denoise/buffers.h"

/* The weighted pixels around one. */
typedef struct RegressionWindow {
    const DenoiseBuffers *buffers;
    int                   x, y;    /* the pixel in the middle */
    int                   reach;   /* the window is 2 reach + 1 wide */
    const float          *weights; /* of the window, row by row; 0 outside of the frame */
} RegressionWindow;

/* Sums over windows, a plane each over the whole frame. */
typedef struct RegressionSums {
    float *light[3], *weight;
} RegressionSums;

/* Fits the half's light in the window and adds the fitted values of its pixels. */
void regression_add(const RegressionWindow *window, int half, const RegressionSums *sums);
