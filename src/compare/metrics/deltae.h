/* SPDX-License-Identifier: Apache-2.0 */
/* deltae.h -- CIEDE2000 colour differences.
 *
 * Source   CIE 142-2001; Sharma, Wu, Dalal, "The CIEDE2000 color-difference formula", Color
 *          Research and Application 30 (2005), with its 34 test pairs. kL = kC = kH = 1.
 * Threads  pure.
 */
#pragma once
#include "compare/metrics/rank.h"

/* Symmetric within rounding; 0 only for equal colours. */
double deltae_2000(const double reference[3], const double test[3]);

/* Linear Rec.709 of displayed pictures, 0 .. 1 (developed frames). map: one value a pixel. */
void deltae_map(const Planes *reference, const Planes *test, float *map);

/* It and its summary: the map holds the masked pixels too. */
MapSummary deltae_pictures(const Planes *reference, const Planes *test, PixelMask mask, float *map);
