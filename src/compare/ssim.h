/* ssim.h -- structural similarity of two pictures of code values.
 *
 * Source   Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment", IEEE TIP 13 (2004):
 *          Gaussian window of 11x11, sigma 1.5, K1 0.01, K2 0.03, on luma of sRGB codes.
 * Units    the planes are sRGB CODES 0 .. 1 here, not linear light.
 * Threads  pure.
 */
#pragma once
#include "base/arena.h"
#include "compare/planes.h"

/* Mean over the pixels that count; 1 for equal pictures. Windows that reach out of the
 * picture are cut off there and weighted anew. map (may be NULL): one value a pixel. */
double ssim_mean(const Planes *reference, const Planes *test, PixelMask mask, float *map,
                 Arena scratch);
