/* SPDX-License-Identifier: Apache-2.0 */
/* flip_filters.h -- the weights that FLIP filters pictures with, along x and along y.
 *
 * Source   Andersson et al. 2020, sections 4.1.1 and 4.2: contrast sensitivity of the eye as
 *          sums of Gaussians, edges and points as derivatives of a Gaussian. All of them are
 *          products of one function of x and one of y.
 * Memory   the weights come from the arena.
 * Threads  plain data.
 */
#pragma once
#include "base/arena.h"

/* weights[k], 0 <= k <= radius, stands for k and -k pixels from the centre. */
typedef struct FlipFilter {
    int radius; /* pixels */
    double *weights;
} FlipFilter;

/* The smoothing filters' weights have the sum 1; blue against yellow is the sum of two.
 * slope is odd, -weights[k] belonging to -k, and its positive weights have the sum 1.
 * curve's positive weights have the sum 1, and its negative ones -1. */
typedef struct FlipFilters {
    int radius; /* the greatest of all */
    FlipFilter lightness, red_green, blue_yellow[2];
    FlipFilter gauss, slope, curve;
} FlipFilters;

/* pixels_per_degree: 1 .. 1000. */
FlipFilters flip_filters_create(double pixels_per_degree, Arena *arena);
