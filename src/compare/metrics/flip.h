/* SPDX-License-Identifier: Apache-2.0 */
/* flip.h -- FLIP and HDR-FLIP: how different two pictures look when one flips between them.
 *
 * Source   Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020;
 *          Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images",
 *          Eurographics 2021 short papers. Constants as of FLIP 1.6.
 * Units    maps hold 0 (the same) .. 1. The reference comes first: HDR-FLIP is not symmetric.
 * Memory   scratch by value: about half a megabyte a thread, for HDR another 5 bytes a pixel,
 *          with a mask another 24.
 * Threads  `threads` of its own for tiles; the same bits for any number.
 * Range    pictures must be finite.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "compare/metrics/rank.h"

#define FLIP_PIXELS_PER_DEGREE 67.0206432766 /* 0.7 m from a screen of 0.7 m and 3840 pixels */

typedef struct FlipOptions {
    double pixels_per_degree; /* 1 .. 1000; 0: FLIP_PIXELS_PER_DEGREE */
    int threads;              /* at least 1 */
    PixelMask mask;           /* what counts: the pictures end there (mask_fill.h); NULL: all */
    bool has_range;           /* HDR: the exposures below, else from the reference */
    double start_ev, stop_ev; /* HDR: light is multiplied by 2^ev; start <= stop */
    int exposures;            /* HDR: 0: ceil(stop - start), at least 2; an empty range: 1 */
} FlipOptions;

/* Linear Rec.709, clamped to 0 .. 1. map: width * height values. Symmetric. */
void flip_ldr(const Planes *reference, const Planes *test, const FlipOptions *options,
              Arena scratch, float *map);

/* The exposures that HDR-FLIP used. */
typedef struct FlipExposures {
    double start_ev, stop_ev;
    int count;
} FlipExposures;

/* Linear Rec.709 of any scale; negative values count as 0. For every pixel the greatest
 * LDR-FLIP of all exposures. The range comes from the whole reference: from the exposure that
 * shows its greatest luminance as 0.85 to the one that does so with its median (of what is not
 * black, where half of it is). With the sun in view nearly all exposures are black, so give a
 * range. A black reference has none: from 0 to 1. */
FlipExposures flip_hdr(const Planes *reference, const Planes *test, const FlipOptions *options,
                       Arena scratch, float *map);
