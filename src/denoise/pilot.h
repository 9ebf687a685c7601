/* SPDX-License-Identifier: Apache-2.0 */
/* pilot.h -- a filtered frame as the guide of the next filter.
 *
 * Patches of filtered light show likeness far better than noisy ones. Each half guides the
 * other one still, so that noise does not choose itself.
 *
 * Memory   of the guide's variance: the arena.
 * Threads  as many as requested; the same bits for any number.
 */
#pragma once
#include "denoise/patch_weights.h"

/* light: of each half, filtered; kept by the guide. The buffers have halves. */
PatchGuide pilot_guide(const DenoiseBuffers *buffers, float *light[2][3], int threads,
                       Arena *arena);
