/* SPDX-License-Identifier: Apache-2.0 */
/* moon_light.h -- how much of the sun's light the moon sends, and how its disc looks.
 *
 * Amount    V = -12.73 + 0.026 |a| + 4e-9 a^4 at 384400 km, a the phase angle in degrees
 *           (Krisciunas and Schaefer 1991, after Allen), beside the sun's V = -26.74: about
 *           0.33 lx above the air at full moon, a tenth of that at the quarters. The surge by
 *           up to a third within 7 degrees of opposition is left out, and so are eclipses,
 *           libration, the difference between waxing and waning (about 5 %) and earthshine.
 * Colour    the sun's B - V is 0.65, the moon's 0.92 (Allen): an albedo that grows as the
 *           wavelength to the power of 1.16.
 * Disc      Lommel and Seeliger's law mu0 / (mu0 + mu): the whole disc even at full moon, dark
 *           beyond the terminator; no maria.
 * Units     radians unless named, km. Threads: pure functions. Fails: never.
 */
#pragma once
#include "spectrum/curve.h"

#define MOON_RADIUS_KM 1737.4

double moon_angular_radius(double distance_km);

/* Where sun, moon and observer stand. */
typedef struct MoonDistances {
    double phase_angle_deg;
    double observer_km; /* to the moon */
    double sun_au;      /* to the moon */
} MoonDistances;

/* Irradiance by the moon on a plane that faces it, over that by the sun at 1 au, at every nm.
 */
void moon_over_sun(const MoonDistances *at, Curve *out);

typedef struct MoonDisc {
    float sine, cosine; /* of the phase angle, which is held below 175 degrees */
    float scale;        /* one over the mean of the law over the disc */
} MoonDisc;

MoonDisc moon_disc(double phase_angle);

/* HOT. Radiance over the disc's mean at a place given in radii: x towards the sun's side, and
 * its squared distance from the centre, below 1. */
float moon_disc_shade(const MoonDisc *disc, float x, float distance2);
