/* SPDX-License-Identifier: Apache-2.0 */
/* peak_range.h -- which mirrors, and which haze under them, the rows of a window allow.
 *
 * All widths and powers of the haze are asked that explain the rows nearly as well as the best
 * ones (chi squared within 4 of theirs: two standard deviations), each with what its own least
 * squares leave open.
 *
 * Units    radians, sr^-1, reflectances of 1. Memory: none. Threads: as the window's.
 * Fails    never.
 */
#pragma once
#include <stdbool.h>

#include "panel/fit/reflection/peak_window.h"

#define PEAK_RANGE_ROWS 8 /* fewer rows do not determine a model with five numbers */

/* Least and most of each, means over the wavelengths. */
typedef struct PeakRange {
    double mirror[2];
    double haze[2];   /* under the peak, with the lambertian part */
    double fwhm[2];   /* of the haze, across the plane of incidence */
    double spread;    /* half of what the haze may vary by, relative: the largest one from the
                         mirror direction to two steps of the rows from it */
    bool   has_model; /* false: too few rows; only the mirror's range is set then */
} PeakRange;

/* sigma: by what a row may miss the model, relative. step: of the rows, radians. */
PeakRange peak_range_find(const PeakWindow *window, const PeakModel *best, double sigma,
                          double step);
