/* SPDX-License-Identifier: Apache-2.0 */
/* hour_sky.h -- skies of a weather file's hours, each of its own, and what a response reads
 * under them.
 *
 * Every hour has a Perez sky (sky/daylight.h): a shape of five numbers, one spectrum, a floor,
 * a sun. Its luminance at the triangles of a response is worked out for each sun, sixteen
 * triangles at a time; the gradation over the zenith angle serves all headings of an hour. So
 * nothing is interpolated: a reading is that of daylight_build but for the quadrature that
 * scales the sky (HOUR_SKY_STEPS: within 5e-4).
 *
 * Frame    suns: directions of the scene (+Y up).
 * Units    cd m^-2; lx of the sun on a plane that faces it. Readings: the response's.
 * Memory   from the arena: 256 bytes an hour, 8 a sun; scratch: 0.6 MB a response.
 * Threads  starts its own; the same numbers for any count.
 * Fails    as daylight_build.
 */
#pragma once
#include "review/light/sky_table.h"
#include "review/light/response.h"

#define HOUR_SKY_STEPS 40

typedef struct HourSky {
    SkyShape shape;
    float scale;                    /* cd m^-2 per unit of the shape */
    float sky_bands[LIGHT_BANDS];   /* for a sky of 1 cd m^-2 */
    float floor_bands[LIGHT_BANDS]; /* whole */
    float sun_bands[LIGHT_BANDS];   /* the part of the disc that is up */
} HourSky;

/* Those of a sweep. */
typedef struct HourSkies {
    const HourSky *list;
    const int *of_sun; /* [sun] into list; NO_ID: no light comes from outside */
} HourSkies;

typedef struct HourInputs {
    const DaylightInput *list; /* all DAYLIGHT_PEREZ */
    int count;
} HourInputs;

/* One for each input. *failed: which one could not be built. */
bool hour_skies_build(const HourInputs *inputs, int threads, Arena *arena, const HourSky **out,
                      int *failed, Error *err);

/* A response's readings of sky and floor under each of `count` suns: [sun]. */
double *hour_skies_read(const HourSkies *skies, const Response *response, const Vec3 *suns,
                        int count, int threads, Arena *arena);
