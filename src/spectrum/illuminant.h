/* SPDX-License-Identifier: Apache-2.0 */
/* illuminant.h -- light of a colour temperature.
 *
 * From 4000 K on CIE daylight (CIE 15: chromaticity and the components S0, S1, S2), below it a
 * black body. At 4000 K the two differ: daylight lies above the Planckian locus.
 *
 * Units    kelvin; W m^-2 sr^-1 nm^-1 of a source of 1 cd m^-2. Threads: pure functions.
 */
#pragma once
#include "spectrum/curve.h"

#define CCT_LEAST_K 1000.0
#define CCT_MOST_K 25000.0 /* up to here CIE 15 defines daylight */
#define CCT_DAYLIGHT_K 4000.0

/* kelvin: CCT_LEAST_K to CCT_MOST_K. */
void cct_curve(double kelvin, Curve *out);
