/* SPDX-License-Identifier: Apache-2.0 */
/* sample_shares.h -- how many of a frame's samples each pixel takes.
 *
 * A frame counts samples from 0; a pixel of share s takes s of each SAMPLE_SHARE_ALL of them,
 * and numbers its own from 0 as well. A share is settled before the first sample, so that no
 * sample decides about another: each pixel's mean is without bias, and parts, crops and runs
 * that go on from a checkpoint take the same samples.
 *
 * Threads  const.
 */
#pragma once
#include <stddef.h>

#include "film/film_sample.h"

#define SAMPLE_SHARE_ALL 64u

typedef struct SampleShares {
    const uint8_t *of; /* row by row of rect, 1 to SAMPLE_SHARE_ALL; NULL: all take all */
    FilmRect rect;
} SampleShares;

/* HOT. The share of a pixel of the rectangle. */
static inline uint32_t sample_shares_at(const SampleShares *shares, int x, int y) {
    size_t columns = (size_t)(shares->rect.x1 - shares->rect.x0);
    if (!shares->of) return SAMPLE_SHARE_ALL;
    return shares->of[(size_t)(y - shares->rect.y0) * columns + (size_t)(x - shares->rect.x0)];
}

/* HOT. How many samples of its own a pixel has taken once the frame has so many: rounded up,
 * so that none stays without. */
static inline uint32_t sample_shares_own(uint32_t share, uint32_t samples) {
    return (uint32_t)(((uint64_t)samples * share + SAMPLE_SHARE_ALL - 1) / SAMPLE_SHARE_ALL);
}

/* Pixels that take all. */
uint64_t sample_shares_whole(const SampleShares *shares);

/* Samples that the pixels of a part of the rectangle take of the frame's [first, end). */
uint64_t sample_shares_sum(const SampleShares *shares, FilmRect part, uint32_t first, uint32_t end);
