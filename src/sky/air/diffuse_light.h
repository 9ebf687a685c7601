/* SPDX-License-Identifier: Apache-2.0 */
/* diffuse_light.h -- light that has been scattered more than once, in flat layers of air.
 *
 * Successive orders of scattering in a plane-parallel atmosphere over a Lambertian ground, lit
 * by a sun whose beam takes its true, spherical way (pseudo-spherical; Dahlback and Stamnes
 * 1991): good until the sun is about 4 degrees below the horizon; below, where light comes from
 * lit air beyond the Earth's shadow, sphere_light.h fills the same tables. Directions: 8 Gauss
 * cosines a side, azimuth as a cosine series (Chandrasekhar 1960, chapter 6).
 *
 * Units     per unit of the sun's spectral irradiance outside the air: sources in sr^-1 m^-1,
 *           irradiances without unit. Lanes as air.h.
 * Memory    the arena's. Threads: const once built.
 */
#pragma once
#include "base/arena.h"
#include "sky/air/air.h"

#define DIFFUSE_LEVELS 48
#define DIFFUSE_MODES 6
#define DIFFUSE_COSINES 17 /* of directions, evenly from -1 to 1 */

typedef struct DiffuseLight {
    double floor_m; /* where the ground or the cloud deck is */
    double top_m;
    int level_count;
    double level_m[DIFFUSE_LEVELS]; /* rising from the floor to the top, as diffuse_level_m */
    /* Scattered into a direction at a level, m^-1 sr^-1, from light that was scattered or
     * reflected before: [level][cosine][mode]; sum over modes of source cos(mode * azimuth),
     * azimuth between its travel and the beam's: that between a look along it and the sun. */
    Spectrum *source;
    float rise; /* logarithm of the next sun angle's light over this one's, where that is how
                 * light lies between the two; 0: it lies on a straight line */
    Spectrum ground_direct, ground_diffuse; /* irradiance on the floor */
    Spectrum top_exitance;                  /* what leaves for space */
} DiffuseLight;

typedef struct DiffuseInput {
    const AirOptics *optics;
    double floor_m, floor_albedo;
    double sun_cosine; /* of its angle to the zenith */
    int orders;        /* of scattering, at most; 0: until a thousandth is left */
} DiffuseInput;

void diffuse_light_build(const DiffuseInput *input, Arena *arena, DiffuseLight *out);

/* Altitude of a level: close together near the floor, where the aerosol is. */
double diffuse_level_m(const DiffuseLight *light, int level);

/* A place in the tables, the same in all lights of the same levels. */
typedef struct DiffusePlace {
    int level, cosine;
    float weight[4]; /* of both cosines at the level, and at the next */
} DiffusePlace;

/* The place of an altitude and a direction of travel. cosine: of that to the zenith. */
DiffusePlace diffuse_light_place(const DiffuseLight *light, double altitude_m, float cosine);

/* The source there, as a series in the azimuth. */
void diffuse_light_modes(const DiffuseLight *light, const DiffusePlace *at,
                         Spectrum mode[DIFFUSE_MODES]);

/* Its sum for the cosine of the travel's azimuth from the beam's (1: light for an eye that
 * looks towards the sun). By pointer, because every build of the hot sources calls this one. */
void diffuse_light_source(const Spectrum mode[DIFFUSE_MODES], float azimuth_cosine, Spectrum *out);
