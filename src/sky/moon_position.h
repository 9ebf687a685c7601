/* SPDX-License-Identifier: Apache-2.0 */
/* moon_position.h -- where the moon stands, how far it is and how much of it is lit.
 *
 * Source    Meeus, Astronomical Algorithms (1998), chapter 47: the 60 greatest terms each of
 *           ELP 2000-82, 10 arc seconds in longitude, 4 in latitude; nutation, sidereal time
 *           and the sun from sun_position.h. From the Earth's centre to the place by vectors on
 *           the same ellipsoid.
 * Units     degrees, km; azimuth from north over east; elevations without refraction.
 * Threads   pure functions. Fails: never.
 */
#pragma once
#include "sky/sun_position.h"

typedef struct MoonPosition {
    /* as seen from the Earth's centre; of the mean equinox of date, then with nutation */
    double longitude_deg, latitude_deg, distance_km;
    double apparent_longitude_deg, right_ascension_deg, declination_deg;
    /* as seen from the place */
    double azimuth_deg, elevation_deg, topocentric_km;
    double sun_azimuth_deg, sun_elevation_deg;
    double elongation_deg;  /* between the centres of moon and sun, 0 to 180 */
    double phase_angle_deg; /* at the moon, between sun and observer: 0 is full */
    double illuminated;     /* share of the disc that the sun shines on */
    double sun_moon_au;
} MoonPosition;

/* julian_day: UT. */
MoonPosition moon_position(double julian_day, double delta_t_s, const SkyPlace *place);
