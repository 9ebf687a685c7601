/* SPDX-License-Identifier: Apache-2.0 */
/* lit_air.h -- the atmosphere (atmosphere.h) under a beam of known spectrum: sun or moon.
 *
 * Frame     elevation from the observer's horizontal, azimuth from the beam's source, radians.
 * Units     spectral radiance in W m^-2 sr^-1 nm^-1; cd m^-2.
 * Memory    the arena's. Threads: const once built. Fails: as atmosphere_build.
 */
#pragma once
#include "sky/atmosphere.h"
#include "spectrum/curve.h"

typedef struct LitAir {
    Atmosphere atmosphere;
    Curve beam;                /* spectral irradiance outside the air, less what gases take */
    uint8_t node[CURVE_COUNT]; /* lane of air.h below each nm */
    float luminance_weight[SPECTRUM_LANES]; /* luminance of a relative radiance */
} LitAir;

bool lit_air_build(const AtmosphereInput *input, const Curve *beam, Arena *arena, LitAir *out,
                   Error *err);

/* HOT. */
Spectrum lit_air_radiance(const LitAir *air, float elevation, float azimuth,
                          const Wavelengths *wavelengths);

/* HOT. How far that is linearly polarised, [0, 1] (atmosphere_polarised). */
Spectrum lit_air_polarisation(const LitAir *air, float elevation, float azimuth,
                              const Wavelengths *wavelengths);

/* For a relative quantity at the lanes of air.h: its spectrum at every nm, and its luminance
 * (illuminance, where it is an irradiance). */
void lit_air_curve(const LitAir *air, Spectrum relative, Curve *out);
double lit_air_luminance(const LitAir *air, Spectrum relative);
