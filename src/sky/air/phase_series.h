/* SPDX-License-Identifier: Apache-2.0 */
/* phase_series.h -- phase functions as series: in Legendre polynomials of the angle between two
 * directions, hence in the azimuth between them (Chandrasekhar 1960, chapter 6), with a
 * quadrature over the sphere's cosines.
 *
 * Threads   pure functions of constants.
 */
#pragma once
#include "sky/air/air.h"

#define PHASE_SIDE 8 /* cosines up, and down */
#define PHASE_MOMENTS 16

/* Gauss and Legendre's on [0, 1]. */
extern const double phase_cosine[PHASE_SIDE], phase_weight[PHASE_SIDE];

/* Associated Legendre functions with sqrt((l-m)!/(l+m)!), for one m and l from 0. */
void phase_legendre(int m, double x, double value[PHASE_MOMENTS]);

/* Mode m of the phase function (sr^-1 times 4 pi) between two cosines, from both's functions:
 * the whole is the sum over m of (m ? 2 : 1) mode cos(m azimuth). */
float phase_series_mode(AirPart part, const double a[PHASE_MOMENTS], const double b[PHASE_MOMENTS],
                        int m);
