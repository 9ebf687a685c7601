/* SPDX-License-Identifier: Apache-2.0 */
/* night_background.h -- the moonless night sky: airglow, zodiacal light and integrated
 * starlight as one smooth background.
 *
 * Amount    2.3e-4 cd m^-2 at the zenith above the air: 21.8 mag per square arc second below
 *           a mountain's, between the 21.9 of a solar minimum and the 21.5 of a maximum, and in
 *           its shares: airglow 145, zodiacal light 60, starlight 15 of 220 (Benn and Ellison
 *           1998).
 * Course    X exp(-depth X) with X = (1 - 0.96 sin^2 Z)^-1/2: van Rhijn's thickening of a thin
 *           layer, thinned by the air on the way (Krisciunas and Schaefer 1991).
 * Spectrum  airglow: its lines 557.7, 589.3 and 630.0 nm (250, 50 and 60 rayleigh; Leinert et
 *           al. 1998), each widened to 30 nm, since a path carries 16 wavelengths, on an even
 *           continuum; the rest has the sun's spectrum.
 * Left out  single stars, the Milky Way, the zodiacal light's cone, the moon's and the sun's
 *           season, and towns. The ground under it is lit by it alone.
 * Units     radians; cd m^-2, lx. Threads: const once built. Fails: never.
 */
#pragma once
#include "spectrum/curve.h"

typedef struct NightBackground {
    float zenith_cd_m2; /* above the air */
    float depth;        /* optical, straight up, for the eye */
    float horizon;      /* elevation of the edge of the floor */
    float floor_cd_m2;
    double horizontal_lx;
    Curve curve; /* spectral radiance of 1 cd m^-2 */
} NightBackground;

typedef struct NightBackgroundInput {
    double depth, horizon, floor_albedo;
    const Curve *sun; /* spectrum outside the air, any scale */
} NightBackgroundInput;

NightBackground night_background(const NightBackgroundInput *input);

/* HOT. cd m^-2, sky or floor. */
float night_background_luminance(const NightBackground *background, float elevation);
