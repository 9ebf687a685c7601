/* SPDX-License-Identifier: Apache-2.0 */
/* regions.h -- the family of tests of regions: the frame, every display, what each reflects.
 *
 * A display is what it sends by itself (measure/display_part.h) where both frames have the
 * layers that show it: what lies around moves nothing of it. Else its pixels count whole, by
 * the reference's id.display.
 *
 * Memory   the list and its names come from the arena.
 * Threads  pure.
 */
#pragma once
#include "compare/statistic/noisy_pair.h"

/* One part of the frame whose mean is tested for itself. */
typedef struct StatisticRegion {
    const char *name;  /* "frame", a display's in the reference, "cluster reflected" */
    const char *words; /* "the frame", "display cluster", "display cluster, reflected light" */
    long pixels;
    double reference, test; /* mean luminance, cd m^-2; of a display over its own area */
    double shift;           /* test / reference - 1; NaN for a black reference */
    double shift_sigma;     /* its standard error */
    double change;          /* the best estimate of a change in proportion, and its error: the */
    double change_sigma;    /* surer pixels count more; NaN: it is no proportion */
    double p_value;         /* two-sided */
    bool moved; /* after the correction for how many are tested; of shift and change one is
                   known to be none: its 95 % interval holds no 0 */
} StatisticRegion;

typedef struct RegionFindings {
    StatisticRegion *list; /* those with pixels; the frame first */
    int count;
    double p;          /* of the family; 1 without regions */
    double mean_shift; /* of the frame; NaN without regions */
} RegionFindings;

/* Whether a change's 95 % interval leaves 0 out. */
bool regions_excludes_none(double change, double sigma);

/* Whether it is one of nothing, or its plain mean's interval leaves 0 out. */
bool regions_shift_is_sure(const StatisticRegion *region);

/* frames: reference, test; level: the family's. */
RegionFindings regions_measure(const NoisyPair *pair, const FrameImage *const frames[2],
                               double level, Arena *arena);
