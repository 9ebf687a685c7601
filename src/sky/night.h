/* SPDX-License-Identifier: Apache-2.0 */
/* night.h -- what lights a clear night: the moon, its light in the air, and the background.
 *
 * The moon is a weak sun: its beam takes the sun's way through the same air (atmosphere.h), and
 * its scattered light comes from tables of its own. Of its light in the air something is left
 * until it stands 9 degrees below the horizontal; below it is a thousandth of the background.
 *
 * Frame     azimuth from north over east, elevation from the horizontal, radians; the moon's
 *           elevation is the apparent one (refraction lifts it).
 * Units     spectral radiance in W m^-2 sr^-1 nm^-1, 360..830 nm; lx; cd m^-2.
 * Memory    the arena's. Threads: const once built. Fails: as atmosphere_build.
 */
#pragma once
#include "sky/lit_air.h"
#include "sky/moon_light.h"
#include "sky/moon_position.h"
#include "sky/night_background.h"

/* For people and scripts. */
typedef struct NightMetrics {
    bool has_moon;    /* its place is known, whether or not it gives light */
    bool is_moon_up;  /* part of its disc at least */
    bool is_moon_lit; /* the sky has its light */
    double moon_azimuth_deg, moon_elevation_deg; /* apparent */
    double moon_distance_km, elongation_deg, phase_angle_deg, illuminated;
    double moon_normal_lx, moon_sky_lx; /* by its disc; by its light in the air, horizontal */
    double background_lx;               /* horizontal */
    double floor_cd_m2;
} NightMetrics;

typedef struct NightInput {
    AtmosphereInput air; /* the sun's elevation is not used */
    Air above;           /* what lies above the observer */
    double altitude_m, horizon;
    const MoonPosition *moon; /* NULL: none */
} NightInput;

typedef struct Night {
    NightMetrics metrics;
    NightBackground background;
    bool has_moonlight; /* in the air */
    LitAir moonlight;
    bool has_moon; /* its disc */
    double moon_azimuth, moon_elevation, moon_radius;
    double sun_azimuth, sun_elevation; /* where its light comes from */
    Curve moon_mean;                   /* disc's mean radiance */
    MoonDisc disc;
} Night;

/* The moon's figures, before anything else is known: without its light. */
NightMetrics night_moon_metrics(const MoonPosition *moon, double altitude_m, double horizon);

bool night_build(const NightInput *input, Arena *arena, Night *out, Error *err);

/* HOT. Sky or floor, without the disc. */
Spectrum night_radiance(const Night *night, float elevation, float azimuth,
                        const Wavelengths *wavelengths);

/* Its luminance, cd m^-2. */
float night_luminance(const Night *night, float elevation, float azimuth);

/* Adds what comes from the zenith, spectral radiance at every nm. */
void night_add_zenith(const Night *night, Curve *zenith);

/* HOT. Radiance of the moon's disc at a place of it (moon_light.h). */
Spectrum night_moon(const Night *night, float x, float distance2, const Wavelengths *wavelengths);
