/* SPDX-License-Identifier: Apache-2.0 */
/* denoise.h -- a frame without most of its noise, for a picture to look at.
 *
 * Never for figures: what is measured, compared or judged is the frame itself. README.md
 * describes the method and its cost.
 *
 * Units    cd m^-2.
 * Memory   the new frame comes from the arena; 300 bytes a pixel of scratch.
 * Threads  as many as requested; the same bits for any number.
 * Fails    when the frame lacks a layer that the filter goes by (DENOISE_LAYERS).
 */
#pragma once
#include "denoise/buffers.h"

typedef struct DenoiseReport {
    bool   has_halves;    /* else each pixel's noise chose its own weights: under 24 samples */
    long   fireflies;     /* pixels whose excess was spread */
    double energy_ratio;  /* luminance of the filtered frame by that of the frame, summed up;
                             pixels that are not finite left out */
} DenoiseReport;

/* A frame of R, G, B alone. */
bool denoise_frame(const FrameImage *frame, int threads, Arena *arena, FrameImage *out,
                   DenoiseReport *report, Error *err);
