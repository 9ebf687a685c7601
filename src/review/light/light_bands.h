/* SPDX-License-Identifier: Apache-2.0 */
/* light_bands.h -- what each band of a path's wavelengths gives of a light's luminance.
 *
 * A path's lane i lies in band i of the spectrum, wherever its offset puts it
 * (spectrum/wavelengths.h); the luminance of a light is the sum over lanes, and so over bands.
 *
 * Units    cd m^-2 of sky, lx of a sun on a plane that faces it.
 * Threads  pure functions.
 */
#pragma once
#include "sky/daylight.h"

#define LIGHT_BANDS SPECTRUM_LANES

/* Sky or floor; elevation and azimuth in radians, as daylight_radiance. */
void light_bands_sky(const Daylight *daylight, float elevation, float azimuth,
                     float bands[LIGHT_BANDS]);

/* A spectral radiance as a curve. */
void light_bands_curve(const Curve *curve, float bands[LIGHT_BANDS]);

/* Equal-energy white; they add up to 1. */
void light_bands_white(float bands[LIGHT_BANDS]);

/* A response's reading of a light: the sum of the products over bands. */
double light_bands_sum(const float shares[LIGHT_BANDS], const float bands[LIGHT_BANDS]);

/* The sun's disc; all 0 where it is down. */
void light_bands_sun(const Daylight *daylight, float bands[LIGHT_BANDS]);
