/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/moon_position.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "sky/sky_degrees.h"
#include "sky/sun_disc.h"

#define EARTH_RADIUS_KM 6378.14

/* ---- periodic terms of the moon's motion ------------------------------------------------- */

/* multiple: of the moon's elongation D, the sun's anomaly M, the moon's anomaly M' and its
 * argument of latitude F. sine in 1e-6 degrees, cosine in m. */
typedef struct MoonTerm {
    int multiple[4];
    double sine, cosine;
} MoonTerm;

#define MOON_TERMS 60
/* Meeus, tables 47.A and 47.B; the longitude's with the distance's cosines. */
static const MoonTerm longitude_terms[MOON_TERMS] = {{{0, 0, 1, 0}, 6288774, -20905355},
                                                     {{2, 0, -1, 0}, 1274027, -3699111},
                                                     {{2, 0, 0, 0}, 658314, -2955968},
                                                     {{0, 0, 2, 0}, 213618, -569925},
                                                     {{0, 1, 0, 0}, -185116, 48888},
                                                     {{0, 0, 0, 2}, -114332, -3149},
                                                     {{2, 0, -2, 0}, 58793, 246158},
                                                     {{2, -1, -1, 0}, 57066, -152138},
                                                     {{2, 0, 1, 0}, 53322, -170733},
                                                     {{2, -1, 0, 0}, 45758, -204586},
                                                     {{0, 1, -1, 0}, -40923, -129620},
                                                     {{1, 0, 0, 0}, -34720, 108743},
                                                     {{0, 1, 1, 0}, -30383, 104755},
                                                     {{2, 0, 0, -2}, 15327, 10321},
                                                     {{0, 0, 1, 2}, -12528, 0},
                                                     {{0, 0, 1, -2}, 10980, 79661},
                                                     {{4, 0, -1, 0}, 10675, -34782},
                                                     {{0, 0, 3, 0}, 10034, -23210},
                                                     {{4, 0, -2, 0}, 8548, -21636},
                                                     {{2, 1, -1, 0}, -7888, 24208},
                                                     {{2, 1, 0, 0}, -6766, 30824},
                                                     {{1, 0, -1, 0}, -5163, -8379},
                                                     {{1, 1, 0, 0}, 4987, -16675},
                                                     {{2, -1, 1, 0}, 4036, -12831},
                                                     {{2, 0, 2, 0}, 3994, -10445},
                                                     {{4, 0, 0, 0}, 3861, -11650},
                                                     {{2, 0, -3, 0}, 3665, 14403},
                                                     {{0, 1, -2, 0}, -2689, -7003},
                                                     {{2, 0, -1, 2}, -2602, 0},
                                                     {{2, -1, -2, 0}, 2390, 10056},
                                                     {{1, 0, 1, 0}, -2348, 6322},
                                                     {{2, -2, 0, 0}, 2236, -9884},
                                                     {{0, 1, 2, 0}, -2120, 5751},
                                                     {{0, 2, 0, 0}, -2069, 0},
                                                     {{2, -2, -1, 0}, 2048, -4950},
                                                     {{2, 0, 1, -2}, -1773, 4130},
                                                     {{2, 0, 0, 2}, -1595, 0},
                                                     {{4, -1, -1, 0}, 1215, -3958},
                                                     {{0, 0, 2, 2}, -1110, 0},
                                                     {{3, 0, -1, 0}, -892, 3258},
                                                     {{2, 1, 1, 0}, -810, 2616},
                                                     {{4, -1, -2, 0}, 759, -1897},
                                                     {{0, 2, -1, 0}, -713, -2117},
                                                     {{2, 2, -1, 0}, -700, 2354},
                                                     {{2, 1, -2, 0}, 691, 0},
                                                     {{2, -1, 0, -2}, 596, 0},
                                                     {{4, 0, 1, 0}, 549, -1423},
                                                     {{0, 0, 4, 0}, 537, -1117},
                                                     {{4, -1, 0, 0}, 520, -1571},
                                                     {{1, 0, -2, 0}, -487, -1739},
                                                     {{2, 1, 0, -2}, -399, 0},
                                                     {{0, 0, 2, -2}, -381, -4421},
                                                     {{1, 1, 1, 0}, 351, 0},
                                                     {{3, 0, -2, 0}, -340, 0},
                                                     {{4, 0, -3, 0}, 330, 0},
                                                     {{2, -1, 2, 0}, 327, 0},
                                                     {{0, 2, 1, 0}, -323, 1165},
                                                     {{1, 1, -1, 0}, 299, 0},
                                                     {{2, 0, 3, 0}, 294, 0},
                                                     {{2, 0, -1, -2}, 0, 8752}};

static const MoonTerm latitude_terms[MOON_TERMS] = {
    {{0, 0, 0, 1}, 5128122, 0}, {{0, 0, 1, 1}, 280602, 0},  {{0, 0, 1, -1}, 277693, 0},
    {{2, 0, 0, -1}, 173237, 0}, {{2, 0, -1, 1}, 55413, 0},  {{2, 0, -1, -1}, 46271, 0},
    {{2, 0, 0, 1}, 32573, 0},   {{0, 0, 2, 1}, 17198, 0},   {{2, 0, 1, -1}, 9266, 0},
    {{0, 0, 2, -1}, 8822, 0},   {{2, -1, 0, -1}, 8216, 0},  {{2, 0, -2, -1}, 4324, 0},
    {{2, 0, 1, 1}, 4200, 0},    {{2, 1, 0, -1}, -3359, 0},  {{2, -1, -1, 1}, 2463, 0},
    {{2, -1, 0, 1}, 2211, 0},   {{2, -1, -1, -1}, 2065, 0}, {{0, 1, -1, -1}, -1870, 0},
    {{4, 0, -1, -1}, 1828, 0},  {{0, 1, 0, 1}, -1794, 0},   {{0, 0, 0, 3}, -1749, 0},
    {{0, 1, -1, 1}, -1565, 0},  {{1, 0, 0, 1}, -1491, 0},   {{0, 1, 1, 1}, -1475, 0},
    {{0, 1, 1, -1}, -1410, 0},  {{0, 1, 0, -1}, -1344, 0},  {{1, 0, 0, -1}, -1335, 0},
    {{0, 0, 3, 1}, 1107, 0},    {{4, 0, 0, -1}, 1021, 0},   {{4, 0, -1, 1}, 833, 0},
    {{0, 0, 1, -3}, 777, 0},    {{4, 0, -2, 1}, 671, 0},    {{2, 0, 0, -3}, 607, 0},
    {{2, 0, 2, -1}, 596, 0},    {{2, -1, 1, -1}, 491, 0},   {{2, 0, -2, 1}, -451, 0},
    {{0, 0, 3, -1}, 439, 0},    {{2, 0, 2, 1}, 422, 0},     {{2, 0, -3, -1}, 421, 0},
    {{2, 1, -1, 1}, -366, 0},   {{2, 1, 0, 1}, -351, 0},    {{4, 0, 0, 1}, 331, 0},
    {{2, -1, 1, 1}, 315, 0},    {{2, -2, 0, -1}, 302, 0},   {{0, 0, 1, 3}, -283, 0},
    {{2, 1, 1, -1}, -229, 0},   {{1, 1, 0, -1}, 223, 0},    {{1, 1, 0, 1}, 223, 0},
    {{0, 1, -2, -1}, -220, 0},  {{2, 1, -1, -1}, -220, 0},  {{1, 0, 1, 1}, -185, 0},
    {{2, -1, -2, -1}, 181, 0},  {{0, 1, 2, 1}, -177, 0},    {{4, 0, -2, -1}, 176, 0},
    {{4, -1, -1, -1}, 166, 0},  {{1, 0, 1, -1}, -164, 0},   {{4, 0, 1, -1}, 132, 0},
    {{1, 0, -1, -1}, -119, 0},  {{4, -1, 0, -1}, 115, 0},   {{2, -2, 0, 1}, 107, 0}};

/* ---- the theory -------------------------------------------------------------------------- */

/* Meeus's 47.1 to 47.6 at a Julian century of dynamical time. */
typedef struct Arguments {
    double mean_longitude, of[4]; /* D, M, M', F; degrees */
    double eccentricity;          /* E: terms of M shrink with the Earth's orbit's */
    double century;
} Arguments;

static Arguments arguments_at(double t) {
    double t2 = t * t, t3 = t2 * t, t4 = t3 * t;
    return (Arguments){
        218.3164477 + 481267.88123421 * t - 0.0015786 * t2 + t3 / 538841 - t4 / 65194000,
        {297.8501921 + 445267.1114034 * t - 0.0018819 * t2 + t3 / 545868 - t4 / 113065000,
         357.5291092 + 35999.0502909 * t - 0.0001536 * t2 + t3 / 24490000,
         134.9633964 + 477198.8675055 * t + 0.0087414 * t2 + t3 / 69699 - t4 / 14712000,
         93.2720950 + 483202.0175233 * t - 0.0036539 * t2 - t3 / 3526000 + t4 / 863310000},
        1 - 0.002516 * t - 0.0000074 * t2,
        t};
}

static void add_terms(const MoonTerm *term, const Arguments *at, double *sines, double *cosines) {
    for (int i = 0; i < MOON_TERMS; i++) {
        double angle = 0;
        for (int j = 0; j < 4; j++) angle += term[i].multiple[j] * at->of[j];
        double weight = pow_d(at->eccentricity, fabs((double)term[i].multiple[1]));
        *sines += weight * term[i].sine * sin_deg(angle);
        *cosines += weight * term[i].cosine * cos_deg(angle);
    }
}

/* Planets and the Earth's flattening add A1, A2, A3 and terms of the mean longitude. */
static void geocentric(double century, MoonPosition *p) {
    Arguments at = arguments_at(century);
    double a1 = 119.75 + 131.849 * century, a2 = 53.09 + 479264.290 * century;
    double a3 = 313.45 + 481266.484 * century, l = at.mean_longitude, f = at.of[3];
    double longitude = 3958 * sin_deg(a1) + 1962 * sin_deg(l - f) + 318 * sin_deg(a2);
    double latitude = -2235 * sin_deg(l) + 382 * sin_deg(a3) + 175 * sin_deg(a1 - f) +
                      175 * sin_deg(a1 + f) + 127 * sin_deg(l - at.of[2]) -
                      115 * sin_deg(l + at.of[2]);
    double distance = 0, none = 0;
    add_terms(longitude_terms, &at, &longitude, &distance);
    add_terms(latitude_terms, &at, &latitude, &none);
    p->longitude_deg = turn_deg(l + longitude * 1e-6);
    p->latitude_deg = latitude * 1e-6;
    p->distance_km = 385000.56 + distance * 1e-3;
}

/* ---- from the place ---------------------------------------------------------------------- */

typedef struct Vector {
    double x, y, z;
} Vector;

static double dot(Vector a, Vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static Vector along(double longitude_deg, double latitude_deg, double length) {
    double across = length * cos_deg(latitude_deg);
    return (Vector){across * cos_deg(longitude_deg), across * sin_deg(longitude_deg),
                    length * sin_deg(latitude_deg)};
}

static double angle_deg(Vector a, Vector b) {
    Vector c = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return degrees_from_radians(atan2_d(sqrt(dot(c, c)), dot(a, b)));
}

/* From ecliptic to equatorial axes of date. */
static Vector equatorial(MoonPosition *p, double obliquity_deg) {
    Vector e = along(p->apparent_longitude_deg, p->latitude_deg, p->distance_km);
    double c = cos_deg(obliquity_deg), s = sin_deg(obliquity_deg);
    Vector q = {e.x, c * e.y - s * e.z, s * e.y + c * e.z};
    p->right_ascension_deg = turn_deg(degrees_from_radians(atan2_d(q.y, q.x)));
    p->declination_deg = degrees_from_radians(asin_d(q.z / p->distance_km));
    return q;
}

/* The place on the ellipsoid, km from the Earth's centre, on the meridian of sidereal_deg. */
static Vector place_vector(const SkyPlace *place, double sidereal_deg) {
    double latitude = radians_from_degrees(place->latitude_deg);
    double reduced = atan2_d(EARTH_FLATNESS * sin_d(latitude), cos_d(latitude));
    double height = place->altitude_m / 1000;
    double across = EARTH_RADIUS_KM * cos_d(reduced) + height * cos_d(latitude);
    double up = EARTH_RADIUS_KM * EARTH_FLATNESS * sin_d(reduced) + height * sin_d(latitude);
    return (Vector){across * cos_deg(sidereal_deg), across * sin_deg(sidereal_deg), up};
}

/* North, east and up of the place. */
static Vector horizontal(Vector v, double sidereal_deg, double latitude_deg) {
    double c = cos_deg(sidereal_deg), s = sin_deg(sidereal_deg);
    double cl = cos_deg(latitude_deg), sl = sin_deg(latitude_deg);
    double out = c * v.x + s * v.y;
    return (Vector){cl * v.z - sl * out, c * v.y - s * v.x, cl * out + sl * v.z};
}

/* sun: from the place, km. */
static void set_phase(Vector moon, Vector sun, MoonPosition *p) {
    Vector from_moon = {sun.x - moon.x, sun.y - moon.y, sun.z - moon.z};
    Vector back = {-moon.x, -moon.y, -moon.z};
    p->elongation_deg = angle_deg(moon, sun);
    p->phase_angle_deg = angle_deg(back, from_moon);
    p->illuminated = 0.5 * (1 + cos_deg(p->phase_angle_deg));
    p->sun_moon_au = sqrt(dot(from_moon, from_moon)) / ASTRONOMICAL_UNIT_KM;
}

MoonPosition moon_position(double julian_day, double delta_t_s, const SkyPlace *place) {
    MoonPosition p = {0};
    SunPosition sun = sun_position(julian_day, delta_t_s, place);
    geocentric((julian_day + delta_t_s / 86400 - J2000) / 36525, &p);
    p.apparent_longitude_deg = turn_deg(p.longitude_deg + sun.nutation_longitude_deg);
    Vector centre = equatorial(&p, sun.obliquity_deg);
    double sidereal = sun.apparent_sidereal_deg + place->longitude_deg;
    Vector here = place_vector(place, sidereal);
    Vector seen = {centre.x - here.x, centre.y - here.y, centre.z - here.z};
    Vector moon = horizontal(seen, sidereal, place->latitude_deg);
    p.topocentric_km = sqrt(dot(moon, moon));
    p.azimuth_deg = turn_deg(degrees_from_radians(atan2_d(moon.y, moon.x)));
    p.elevation_deg = degrees_from_radians(asin_d(moon.z / p.topocentric_km));
    p.sun_azimuth_deg = sun.azimuth_deg;
    p.sun_elevation_deg = sun.elevation_deg;
    set_phase(moon,
              along(sun.azimuth_deg, sun.elevation_deg, sun.distance_au * ASTRONOMICAL_UNIT_KM),
              &p);
    return p;
}
