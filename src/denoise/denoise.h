/* SPDX-License-Identifier: Apache-2.0 */
/* denoise.h -- a frame without most of its noise, for a picture to look at.
 *
 * Never for figures: what is measured, compared or judged is the frame itself. README.md
 * describes the method and what it cannot do.
 *
 * Units    cd m^-2.
 * Memory   the new frame comes from the arena; scratch of some 150 KB for each pixel of the
 *          width, and 16 bytes a pixel.
 * Threads  as many as requested; the same bits for any number.
 * Fails    when the frame lacks a layer that is required (DENOISE_LAYERS), and when the weights
 *          are not there or damaged.
 */
#pragma once
#include "image/frame.h"

/* The layers that it goes by, as --layers names them. The last three may be missing: what
 * displays show is then as noisy as the frame's samples have it, lamps that are seen are
 * filtered, by which small ones lose light, and fine textures go with the noise. */
#define DENOISE_LAYERS "normal,albedo,display.emitted,display.fine,emitted,halves"

typedef struct DenoiseReport {
    double energy_ratio; /* luminance of the filtered frame by that of the frame, summed up;
                            pixels that are not finite left out */
    double block_error;  /* of the light that is filtered, what the worst block of 64x64 pixels
                            gained or lost; a share of all its light */
    double left_share;   /* of the pixels that were not filtered: suns, not finite */
} DenoiseReport;

/* Whether the weights are there, before any work for a frame that will be filtered. */
bool denoise_check(Error *err);

/* The frame with other R, G, B; the rest is shared with it. */
bool denoise_frame(const FrameImage *frame, int threads, Arena *arena, FrameImage *out,
                   DenoiseReport *report, Error *err);
