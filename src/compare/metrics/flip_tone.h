/* SPDX-License-Identifier: Apache-2.0 */
/* flip_tone.h -- the curves that show light of any scale on a display, for HDR-FLIP.
 *
 * Source   the fitted curves (p0 x^2 + p1 x + p2) / (p3 x^2 + p4 x + p5) of FLIP 1.6.
 *          Reinhard's is one of luminance, the others are of each channel for itself.
 * Threads  pure functions.
 */
#pragma once

typedef enum FlipToneMapper { FLIP_ACES, FLIP_REINHARD, FLIP_HABLE } FlipToneMapper;

/* Linear Rec.709, at least 0; to display-referred light, which may be above 1. */
void flip_tone_map(FlipToneMapper mapper, double rgb[3]);

/* The light that the curve shows as `shown`, 0 < shown < 1. */
double flip_tone_input(FlipToneMapper mapper, double shown);
