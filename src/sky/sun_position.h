/* SPDX-License-Identifier: Apache-2.0 */
/* sun_position.h -- where the sun stands: NREL's solar position algorithm (SPA).
 *
 * Source    Reda and Andreas, "Solar Position Algorithm for Solar Radiation Applications",
 *           NREL/TP-560-34302 (2008): 0.0003 degrees from the year -2000 to 6000. Own
 *           implementation from the report's formulas.
 * Units     degrees at this interface, as the report; east and north positive; azimuth from
 *           north over east; metres; mbar; degrees Celsius.
 * Threads   pure functions. Fails: only sky_time_parse.
 */
#pragma once
#include "base/error.h"

/* A moment, proleptic Gregorian (Julian before 1582-10-15), with the zone's offset from UTC. */
typedef struct SkyTime {
    int year, month, day, hour, minute;
    double second;
    double zone_h; /* hours east of UTC */
} SkyTime;

/* "2026-06-21T08:30+02:00", seconds ("08:30:15.5") and "Z" allowed; the zone is required: a
 * time without one means nothing without a place's law. `place` names where the text stood. */
bool sky_time_parse(const char *text, const char *place, SkyTime *out, Error *err);

/* The moment some seconds (not negative) later, in the same zone. */
SkyTime sky_time_later(SkyTime when, double seconds);

/* Julian day (UT) of a moment. */
double sky_julian_day(const SkyTime *time);

/* TT - UT1 in seconds: Espenak and Meeus's polynomials (NASA/TP-2006-214141), measured values'
 * smooth course; within 2 s from 1900 to 2030. */
double sky_delta_t_s(double julian_day);

/* Everything on the way, as the report's worked example lists it. */
typedef struct SunPosition {
    double julian_day, julian_century, ephemeris_day, ephemeris_century, ephemeris_millennium;
    double heliocentric_longitude_deg, heliocentric_latitude_deg, distance_au;
    double geocentric_longitude_deg, geocentric_latitude_deg;
    double nutation_argument_deg[5]; /* X0..X4 */
    double nutation_longitude_deg, nutation_obliquity_deg;
    double mean_obliquity_arcsec, obliquity_deg;
    double aberration_deg, apparent_longitude_deg;
    double mean_sidereal_deg, apparent_sidereal_deg;
    double right_ascension_deg, declination_deg;
    double hour_angle_deg;
    double parallax_deg, parallax_right_ascension_deg;
    double topocentric_right_ascension_deg, topocentric_declination_deg;
    double topocentric_hour_angle_deg;
    double elevation_deg; /* true (without refraction) */
    double azimuth_deg;   /* [0, 360), from north over east */
} SunPosition;

typedef struct SkyPlace {
    double latitude_deg, longitude_deg; /* [-90, 90], [-180, 180] */
    double altitude_m;                  /* above sea level */
} SkyPlace;

SunPosition sun_position(double julian_day, double delta_t_s, const SkyPlace *place);

/* Refraction that lifts a true elevation, degrees (Saemundsson 1986, as in the report), scaled
 * by pressure and temperature. Its pole below -5 degrees is avoided by holding the last value
 * at -1 degree and fading it out to nothing at -5; SPA itself switches off at -0.83. */
double sun_refraction_deg(double true_elevation_deg, double pressure_mbar, double celsius);

/* International standard atmosphere (ISO 2533) to 20 km. */
void standard_atmosphere(double altitude_m, double *pressure_mbar, double *celsius);

/* How far the sea's horizon lies below the horizontal, degrees, for a sphere of 6371 km without
 * refraction. */
double horizon_dip_deg(double altitude_m);
