/* SPDX-License-Identifier: Apache-2.0 */
/* emission_peaks.h -- does one sample of a grid alone show a peak or a hole? Then samples do
 * not resolve it: how high and how wide it is between them, nobody measured.
 *
 * A sample that is above both its neighbours on the meridian (on the ring), or below both, is
 * predicted without it: by a cubic through the logarithms of the two samples on either side. Of
 * Gaussian lobes on smooth light (tests/image/foreign_layouts.py: 400 grids, lobes of 0.5 to 20
 * degrees) panels miss between samples what ln of that prediction misses over 1 to 6; 2.5 found
 * all 12 that miss more than 15 %, and called 4 of 86 coarse that do not.
 *
 * Units    radians, cd m^-2. Memory: none of its own. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/shape/panel_profiles.h"

typedef struct EmissionPeak {
    double estimate;   /* what the panel may miss there, relative; 0: no sample stands out */
    double missed;     /* the sample, by its neighbours */
    double theta, phi;
    double step;       /* to the next sample, radians of theta or of azimuth */
    bool   is_azimuth; /* the neighbours are those on the ring */
} EmissionPeak;

/* The peak that costs most, of a channel of thetas x phis x channels. noise: relative; what it
 * explains (twice) is none. Samples below a quarter of the largest are left out. */
EmissionPeak emission_peaks_find(const PanelAxes *grid, const float *cells, int channels,
                                 int channel, double noise);
