/* SPDX-License-Identifier: Apache-2.0 */
/* atmosphere.h -- the clear sky as an observer sees it: an own spectral scattering atmosphere.
 *
 * Light scattered once is marched along every ray through a spherical, layered air (air.h);
 * light scattered more often comes from flat layers lit by the true beam (diffuse_light.h) at
 * the ray's local sun angle. Below lies a Lambertian floor: ground, sea or a cloud deck of an
 * altitude and albedo; a deck may have a relief (cloud_relief.h), which belongs to pictures: it
 * changes what the floor sends towards the observer, before the air in between. What is left
 * out: polarisation, refraction of sky light, clouds above the observer; water vapour and
 * oxygen are the caller's (spectrl2.h).
 *
 * Twilight  A sun seen lower than -2 degrees lights air up to 120 km by bent rays from its true
 *           place (beam_table.h), and light scattered more often travels through the sphere
 *           (sphere_light.h): from -2 to -4 degrees mixed with the day's, below alone. Of the
 *           published illuminance (Explanatory Supplement to the Astronomical Almanac 1992,
 *           p. 491) the horizontal one, with the night's (night_background.h), is 1.12 at 0
 *           degrees, 1.08 at -3, 0.93 at -6, 0.85 at -9, 0.71 at -12, 0.48 at -15, under 0.34
 *           atm cm of ozone: its Chappuis bands decide, and 0.26 give 1.3 times the sun's light
 *           at -6, 1.4 times at -12. Under 0.26 the zenith is 1.00 of the luminance
 *           measured at Paranal (Patat et al. 2006) at -6, 0.82 at -9, 0.74 at -12. Finer
 *           steps, more orders and a thicker thermosphere change these by less than 2 percent.
 *           A sun 27 degrees below the floor's edge is taken to give nothing: just above, its
 *           light is less than a thousandth of the night's in any direction.
 *
 * Frame     elevation from the observer's horizontal, azimuth from the sun's, radians.
 * Units     radiance in sr^-1 per unit of the sun's spectral irradiance outside the air, at the
 *           16 wavelengths of air.h.
 * Memory    the arena's, about 6 MB, 65 MB more while it builds; a relief 7 MB more. Threads:
 *           const once built.
 * Fails     on an observer below the floor or above 60 km.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "sky/air/air.h"
#include "sky/cloud_relief.h"

typedef struct AtmosphereInput {
    Air air;                    /* pressure: at sea level; ground_albedo: of the floor */
    double observer_m, floor_m; /* above sea level */
    double sun_elevation;       /* radians, as seen: by day its light is taken to come straight from
                                 * there, in twilight from where refraction lifts it from */
    int threads;
    int steps;          /* of a ray; 0: 48 */
    bool sun_alone;     /* sun_passing is made, and no table: no direction may be
                           evaluated */
    double relief_m;    /* of the floor, a cloud deck's (cloud_relief.h); 0: it is even */
    double sun_azimuth; /* compass, radians: where the relief is lit from */
} AtmosphereInput;

typedef struct Atmosphere {
    AtmosphereInput input;
    AirOptics optics;
    double horizon;          /* elevation of the floor's edge, radians, at most 0 */
    Spectrum sun_passing;    /* transmittance from the sun's centre to the observer */
    Spectrum floor_exitance; /* light that the floor under the observer sends up, relative */
    /* [below][row][column]: what molecules and aerosol scatter once, without their phase
     * functions, and the rest; row 0 touches the horizon */
    Spectrum *molecules, *aerosol, *rest;
    /* with a relief, else NULL: of `rest` what the floor reflects of the beam, and of the light
     * of the sky, [row][column] below the horizon */
    Spectrum *floor_beam, *floor_sky;
    CloudRelief *relief;
} Atmosphere;

#define ATMOSPHERE_ROWS 96
#define ATMOSPHERE_COLUMNS 49 /* azimuths 0 to 180 degrees */

bool atmosphere_build(const AtmosphereInput *input, Arena *arena, Atmosphere *out, Error *err);

/* Sky or floor in a direction, of a floor with a relief its mean; the sun's disc is not part of
 * it. */
Spectrum atmosphere_radiance(const Atmosphere *atmosphere, float elevation, float azimuth);

/* What a relief adds to that, or takes from it; 0 where there is none. */
Spectrum atmosphere_relief(const Atmosphere *atmosphere, float elevation, float azimuth);

/* The part of that radiance that is linearly polarised, across the plane of sun and direction:
 * light that molecules scattered once, sin^2 / (1 + cos^2) of it for the angle to the sun
 * (Rayleigh). What aerosol scatters, and light scattered more often, counts as unpolarised. */
Spectrum atmosphere_polarised(const Atmosphere *atmosphere, float elevation, float azimuth);

/* Irradiance on a horizontal plane from the sky above the horizontal, relative. */
Spectrum atmosphere_diffuse(const Atmosphere *atmosphere);
