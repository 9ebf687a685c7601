/* SPDX-License-Identifier: Apache-2.0 */
/* ssim.h -- structural similarity of two pictures of code values.
 *
 * Source   Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment", IEEE TIP 13 (2004):
 *          Gaussian window of 11x11, sigma 1.5, K1 0.01, K2 0.03, on luma of sRGB codes
 *          (0.299, 0.587, 0.114: ITU-R BT.601-7, as their program takes it).
 * Units    the planes are sRGB CODES 0 .. 1 here, not linear light.
 * Memory   scratch for 72 doubles a column.
 * Threads  pure.
 */
#pragma once
#include "base/arena.h"
#include "compare/metrics/planes.h"

/* A sum over pixels, one after the other, so that rows that are added piece by piece from the
 * top give the same bits as a whole picture. */
typedef struct SsimSum {
    double sum, members; /* the mean is their quotient */
} SsimSum;

enum { SSIM_RADIUS = 5 }; /* pixels that a window reaches up, down, left and right */

/* Adds rows [y0, y1). Rows around them that the planes hold belong to their windows. */
void ssim_add_rows(SsimSum *sum, const Planes *reference, const Planes *test, PixelMask mask,
                   const int rows[2], Arena scratch);

/* Mean over the pixels that count; 1 for equal pictures, NaN when none counts. Windows that
 * reach out of the picture or over masked pixels are cut off there and weighted anew.
 * map (may be NULL): one value a pixel; 1 where nothing in the window counts. */
double ssim_mean(const Planes *reference, const Planes *test, PixelMask mask, float *map,
                 Arena scratch);
