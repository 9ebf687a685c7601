/* SPDX-License-Identifier: Apache-2.0 */
/* rank.h -- medians and percentiles without sorting and without memory; figures of a map.
 *
 * Values must be finite; negative ones are fine.
 * Threads  pure.
 */
#pragma once
#include "compare/metrics/planes.h"

/* The least of the values that count such that at least `fraction` (0 .. 1) of them are not
 * above it: 0 is the least of all, 1 the greatest. NaN when none counts. */
float rank_value(const float *values, size_t count, PixelMask mask, double fraction);

typedef struct MapSummary {
    double mean, median, p95, max;
} MapSummary;

/* Over the pixels that count; NaN when none does. Percentiles are values of the map. */
MapSummary map_summary(const float *map, size_t count, PixelMask mask);
