/* SPDX-License-Identifier: Apache-2.0 */
/* sun_disc.h -- the sun's disc as a source: its size, its edge, its spectrum.
 *
 * The irradiance on a plane that faces the sun is exact for any look of the disc: radiance
 * is irradiance over pi sin^2 r, shaped by the limb's darkening over its own mean.
 *
 * Source    limb darkening: fifth-order fits in mu of Neckel and Labs's kind at the eleven
 *           bands that Hosek and Wilkie, "Adding a Solar-Radiance Function ..." (2013), print.
 * Units     radians, nm. Threads: pure functions of constants.
 */
#pragma once
#include "spectrum/curve.h"

#define SUN_RADIUS_KM 695700.0
#define ASTRONOMICAL_UNIT_KM 149597870.7

/* Angular radius at a distance in au. */
double sun_angular_radius(double distance_au);

/* Share of a disc above a line at `above` radii over its centre's height (negative: above). */
double disc_share_above(double above);

#define SUN_LIMB_TERMS 6

/* Coefficients over mu^0..5 at a wavelength (linear between bands, ends held), divided by the
 * disc's mean: sum of 2 c_i / (i + 2) is 1. */
void sun_limb(double nm, double coefficient[SUN_LIMB_TERMS]);

/* The same at every nm of a curve. */
void sun_limb_curves(Curve limb[SUN_LIMB_TERMS]);

/* HOT. Radiance over the disc's mean at a sine of the angle to its centre over the sine of its
 * radius. */
Spectrum sun_limb_shade(const Curve limb[SUN_LIMB_TERMS], float share,
                        const Wavelengths *wavelengths);
