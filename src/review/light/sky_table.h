/* SPDX-License-Identifier: Apache-2.0 */
/* sky_table.h -- clear skies by the sun's elevation, for many suns; what lies between is
 * interpolated.
 *
 * Frame    azimuths of the vehicle: 0 ahead, 90 right; elevations apparent; degrees.
 * Memory   from the arena.
 * Threads  one at a time.
 */
#pragma once
#include "spectrum/spectrum.h"
#include "sky/daylight.h"

/* What each band of a path's wavelengths gives of a light's luminance.
 *
 * A path's lane i lies in band i of the spectrum, wherever its offset puts it
 * (spectrum/wavelengths.h); the luminance of a light is the sum over lanes, and so over bands.
 *
 * Units    cd m^-2 of sky, lx of a sun on a plane that faces it.
 * Threads  pure functions. */

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

#define SKY_AZIMUTHS 72 /* of the sun in a turn */

/* Skies that were made, for other tables that have them. */
typedef struct KeptSky KeptSky;
typedef struct SkiesKept {
    Arena *room; /* megabytes a sky */
    const KeptSky *first;
} SkiesKept;

/* Clear skies by the sun's elevation, the earth 1 au away: readings are scaled to each sun's
 * light, the night's own background with them (within 0.4 % at -12 degrees). */
typedef struct SkyTable {
    DaylightInput like;              /* air and ground; suns stand at azimuth 0 */
    const double *elevation_deg;     /* rising */
    float (*sun_bands)[LIGHT_BANDS]; /* lx; 0 before its skies were made */
    int count;
    int first_azimuth, azimuths; /* those of SKY_AZIMUTHS that are made, on from the
                                    first; no other may be read */
    SkiesKept *kept;             /* where its skies are looked for, and left; NULL: nowhere */
} SkyTable;

/* Elevations that reach from `low` to `high`; `like` gives air and ground. Its skies are made
 * when probes need them (distant_probes_sample_skies), one by one: each takes megabytes. */
SkyTable sky_table_start(const DaylightInput *like, double low_deg, double high_deg, Arena *arena);

/* Keeps only the sun's azimuths from low to high, relative to the vehicle; before its skies are
 * made. */
void sky_table_between(SkyTable *table, double low_deg, double high_deg);

/* A sun's bands at an elevation within the table's, lx: within 1 % from 2 degrees on, 3 % or
 * 1 lx below. light: a DistantSun's. */
void sky_table_sun(const SkyTable *table, double elevation_deg, double light,
                   float bands[LIGHT_BANDS]);

/* The sky of a row; its sun is noted. NULL: it failed. */
const Daylight *sky_table_make(SkyTable *table, int row, Arena *arena, Error *err);

/* The suns of all rows alone. */
bool sky_table_make_suns(SkyTable *table, const Arena *arena, Error *err);

/* The table's row at or below an elevation, and its share 0..1 of the way to the next. */
int sky_table_row(const SkyTable *table, double elevation_deg, double *share);
