/* SPDX-License-Identifier: Apache-2.0 */
/* grey_inversion.h -- where a higher grey level gives less light than a lower one, and by how
 * much.
 *
 * Grey is red, green and blue at one code. At a direction the pair of measured levels that is
 * wrong the most counts: share = 1 - L(higher) / L(lower), black included. What is below
 * GREY_INVERSION_LEAST counts as none: no eye sees it between two levels.
 *
 * Units    codes of 255, radians. Memory: the arena's. Threads: const but for the field's own.
 */
#pragma once
#include "plot/panel/plot_data.h"

#define GREY_INVERSION_LEAST 0.01

typedef struct GreyLevels {
    int count;                              /* 0: fewer than two were measured at angles */
    double code[PANEL_INFO_LEVELS_MAX + 1]; /* rising, black first */
} GreyLevels;

GreyLevels grey_levels(const PlotData *data);

typedef struct GreyInversion {
    double share;      /* 0: none */
    double low, high;  /* codes: the lower one is brighter */
    double theta, phi; /* where */
} GreyInversion;

/* The largest along an azimuth, by half degrees up to the measured cone. *first: the theta
 * where it begins, to a hundredth of a degree, NaN where there is none. */
GreyInversion grey_inversion_along(const PlotData *data, const GreyLevels *levels, double phi,
                                   double *first);

/* The largest of all directions: of 72 azimuths, or of those measured where they are few. */
GreyInversion grey_inversion_most(const PlotData *data, const GreyLevels *levels);

/* Percent, over the hemisphere. */
Field grey_inversion_field(const PlotData *data, const GreyLevels *levels, Arena *arena);
