/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_guide.h -- how a table goes on between its rows where they are too far apart for
 * the peak: like the haze that was fitted under the mirror's image.
 *
 * What is read between rows is then the logarithm over the guide's, which is nearly even. A
 * table whose rows are close enough has no guide.
 * Threads  const once chosen. Fails: never.
 */
#pragma once
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/reflection/reflection_peak.h"

typedef struct ReflectionGuide {
    bool   is_used;
    double incidence;
    double width, power, a, lambertian; /* a (1 + b2 / width^2)^-power + lambertian */
    double reach;  /* radians: so far from the mirror direction it was fitted */
    double miss;   /* of reading without it: the largest difference between rows, relative */
} ReflectionGuide;

/* The guide that a peak's model makes. */
ReflectionGuide reflection_guide_of(const PeakMirror *peak, double incidence);

/* ln of it, in a table's frame. */
double reflection_guide_log(const ReflectionGuide *guide, double theta, double phi);

/* Compares reading between the cells, which hold logarithms, with and without the guide, and
 * decides; the middle channel is compared. */
void reflection_guide_choose(const DirectionGrid *grid, const float *cells, int channels,
                             ReflectionGuide *guide);
