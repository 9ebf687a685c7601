/* SPDX-License-Identifier: Apache-2.0 */
/* selection.h -- of a wide and a narrow filter, each pixel's better one.
 *
 * What a filter made of one half of the samples is held against the other half, whose noise it
 * does not have: it differs from it by that noise, the same for both filters, and by the
 * filter's own error (Rousselle, Knaus and Zwicker 2012). Over the pixels around, the smaller
 * difference marks the better filter.
 *
 * Threads  as many as asked; the same bits for any number.
 */
#pragma once
#include "denoise/buffers.h"

/* Both filters' results for each half: R, G, B. */
typedef struct Candidates {
    float *wide[2][3], *narrow[2][3];
} Candidates;

/* Puts into the wide one, of both halves, the better of the two, and a mean of both where it is
 * unsure. The buffers have halves. */
void selection_apply(const DenoiseBuffers *buffers, const Candidates *candidates, int threads,
                     Arena scratch);
