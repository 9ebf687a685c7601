/* SPDX-License-Identifier: Apache-2.0 */
/* adapt.h -- one exposure for a dark cabin and a bright street: local adaptation.
 *
 * Each pixel is darkened by what its surroundings are brighter than middle grey, as an eye that
 * looks there adapts; contrasts inside the surroundings stay. For a look, never for figures.
 *
 * Units    luminance in cd m^-2; brightness in stops above middle grey.
 * Memory   the gains come from the arena.
 * Threads  one.
 */
#pragma once

#include "base/arena.h"

/* The level, in stops above middle grey, that a uniform picture of `stops` is shown at: the
 * same up to middle grey, and above s ln(1 + stops / s) with s = ADAPT_SOFTNESS. Rises
 * everywhere. */
#define ADAPT_SOFTNESS 1.5f
float adapt_stops(float stops);

/* A factor for every pixel, in (0, 1], the same for R, G and B: hues stay. Luminances that are
 * not finite or not above 0 do not count and have the factor 1. At a step of light of any size
 * no pixel leaves the range of the two sides' values by more than 10 %; of a contrast of 10 %
 * inside a bright view at least nine tenths stay. */
float *adapt_gains(const float *luminance_cd_m2, int width, int height, float grey_cd_m2,
                   Arena *arena);
