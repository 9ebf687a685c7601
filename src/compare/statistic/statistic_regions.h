/* SPDX-License-Identifier: Apache-2.0 */
/* statistic_regions.h -- the regions' family of the test: the whole frame, every display, and
 * what every display reflects.
 *
 * Memory   from the arena that is passed in.
 * Threads  pure.
 */
#pragma once
#include "base/arena.h"
#include "compare/statistic/noisy_pair.h"

/* Fills regions, region_count, mean_shift and p_regions of `out`; level is the family's. The
 * names are those of the frame's attributes. */
void statistic_regions(const NoisyPair *pair, const FrameImage *reference, double level,
                       Arena *arena, StatisticResult *out);
