/* SPDX-License-Identifier: Apache-2.0 */
/* scatter_gaps.h -- what a panel may miss between scattered samples of a table.
 *
 * At 2,113 directions, where samples stand all round, the surface through the samples'
 * logarithms states how far it may be off (scatter_surface_doubt), and how far the panel
 * differs from it: a hole between samples costs where the values around it bend, wherever it
 * lies. Estimates are two standard deviations.
 *
 * Memory   scratch. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/fit/common/scatter_surface.h"

typedef struct ScatterGaps {
    double light;      /* the share of the light that may be missed, one standard deviation */
    double worst;      /* relative, where there is a quarter of the largest value */
    double theta, phi; /* of the worst, radians, in the table's frame */
    double gap;        /* from there to the nearest sample, radians */
} ScatterGaps;

/* The panel's logarithm at a direction. *off: the surface's less it. */
typedef double ScatterRead(void *context, Vec3 at, double *off);

/* What is checked in a table. */
typedef struct ScatterAsked {
    const ScatterSurface *surface;
    ScatterRead *read;
    void *context;
} ScatterAsked;

ScatterGaps scatter_gaps_find(const ScatterAsked *asked, Arena scratch);

/* Two standard deviations of a logarithm, as a relative miss. */
double scatter_gaps_miss(double sigma);

/* How close samples would have to stand for `most`; radians. A hole costs by the power 1.5 of
 * its width, the doubt's own law. */
double scatter_gaps_step(const ScatterGaps *gaps, double most);
