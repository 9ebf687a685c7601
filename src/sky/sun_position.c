/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/sun_position.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/calendar.h"
#include "base/mathd.h"
#include "base/units.h"
#include "sky/sky_degrees.h"
#include "sky/sun_position_tables.h"

#define EARTH_RADIUS_M 6378140.0

/* ---- time ------------------------------------------------------------------------------ */

double sky_julian_day(const SkyTime *time)
{
    double year = time->year, month = time->month;
    double hours = time->hour - time->zone_h + (time->minute + time->second / 60) / 60;
    double day = time->day + hours / 24;
    if (month <= 2) {
        year -= 1;
        month += 12;
    }
    double jd = floor(365.25 * (year + 4716)) + floor(30.6001 * (month + 1)) + day - 1524.5;
    double century = floor(year / 100);
    return jd > 2299160 ? jd + 2 - century + floor(century / 4) : jd;
}

double sky_delta_t_s(double julian_day)
{
    /* every five years from 1900 to 2025 */
    static const double measured[] = {-2.72, 3.86,  10.54, 17.20, 21.16, 23.62, 24.02,
                                      23.93, 24.33, 26.77, 29.15, 31.07, 33.15, 35.73,
                                      40.18, 45.48, 50.54, 54.34, 56.86, 60.79, 63.83,
                                      64.69, 66.07, 67.64, 69.36, 69.14};
    double year = 2000 + (julian_day - J2000) / 365.25, u = (year - 1820) / 100;
    if (year < 1900) return -20 + 32 * u * u;
    if (year >= 2050) return -20 + 32 * u * u - 0.5628 * fmax(0, 2150 - year);
    double at = fmin((year - 1900) / 5, 24.9999);
    int    i = (int)at;
    return measured[i] + (at - i) * (measured[i + 1] - measured[i]);
}

SkyTime sky_time_later(SkyTime when, double seconds)
{
    double second = when.hour * 3600 + when.minute * 60 + when.second + seconds;
    double days = floor(second / 86400), rest = second - days * 86400;
    when.hour = (int)(rest / 3600);
    when.minute = (int)((rest - when.hour * 3600) / 60);
    when.second = fmax(0, rest - when.hour * 3600 - when.minute * 60);
    for (when.day += (int)days; when.day > calendar_days_of_month(when.year, when.month);) {
        when.day -= calendar_days_of_month(when.year, when.month);
        when.year += when.month == 12;
        when.month = when.month % 12 + 1;
    }
    return when;
}

static bool time_in_range(const SkyTime *t)
{
    return t->year >= -2000 && t->year <= 6000 && t->month >= 1 && t->month <= 12 &&
           t->day >= 1 && t->day <= calendar_days_of_month(t->year, t->month) &&
           t->hour >= 0 && t->hour <= 23 && t->minute >= 0 && t->minute <= 59 &&
           t->second >= 0 && t->second < 60 && fabs(t->zone_h) <= 14;
}

/* "Z", "+02:00" or "-0330" at `text`; false: anything else. */
static bool parse_zone(const char *text, double *zone_h)
{
    int hours = 0, minutes = 0, used = 0;
    if (!strcmp(text, "Z")) return true;
    if (*text != '+' && *text != '-') return false;
    if (sscanf(text + 1, "%2d:%2d%n", &hours, &minutes, &used) != 2 || text[1 + used]) {
        used = 0;
        if (sscanf(text + 1, "%2d%2d%n", &hours, &minutes, &used) != 2 || text[1 + used])
            return false;
    }
    if (hours < 0 || minutes < 0 || minutes > 59) return false;
    *zone_h = (*text == '-' ? -1 : 1) * (hours + minutes / 60.0);
    return true;
}

bool sky_time_parse(const char *text, const char *place, SkyTime *out, Error *err)
{
    SkyTime t = {0};
    int     used = 0, more = 0;
    bool    ok = sscanf(text, "%d-%2d-%2dT%2d:%2d%n", &t.year, &t.month, &t.day, &t.hour,
                        &t.minute, &used) == 5 && used;
    const char *rest = text + used;
    if (ok && sscanf(rest, ":%lf%n", &t.second, &more) == 1) rest += more;
    if (!ok || !parse_zone(rest, &t.zone_h) || !time_in_range(&t))
        return error_at(err, ERROR_INPUT, place, "",
                        "'%s' is no moment, wanted a date, time and zone such as "
                        "2026-06-21T08:30+02:00", text);
    *out = t;
    return true;
}

/* ---- the report's steps ------------------------------------------------------------------ */

/* sum over powers of time of the series' cosines, in 1e-8 units. */
static double orbit_sum(const OrbitSeries *series, int powers, double millennium)
{
    double total = 0;
    for (int p = powers - 1; p >= 0; p--) {
        double sum = 0;
        for (int i = 0; i < series[p].count; i++) {
            const OrbitTerm *term = &series[p].term[i];
            sum += term->a * cos_d(term->b + term->c * millennium);
        }
        total = total * millennium + sum;
    }
    return total * 1e-8;
}

static double polynomial(const double *coefficient, int count, double x)
{
    double value = 0;
    for (int i = count - 1; i >= 0; i--) value = value * x + coefficient[i];
    return value;
}

/* 3.1 and 3.2: the Earth as seen from the Sun, and turned about. */
static void heliocentric(SunPosition *p)
{
    double t = p->ephemeris_millennium;
    p->heliocentric_longitude_deg = turn_deg(degrees_from_radians(orbit_sum(orbit_longitude, 6,
                                                                            t)));
    p->heliocentric_latitude_deg = degrees_from_radians(orbit_sum(orbit_latitude, 2, t));
    p->distance_au = orbit_sum(orbit_distance, 5, t);
    p->geocentric_longitude_deg = turn_deg(p->heliocentric_longitude_deg + 180);
    p->geocentric_latitude_deg = -p->heliocentric_latitude_deg;
}

/* 3.4: nutation in longitude and obliquity. */
static void nutate(SunPosition *p)
{
    static const double argument[5][4] = {
        {297.85036, 445267.111480, -0.0019142, 1 / 189474.0},
        {357.52772, 35999.050340, -0.0001603, -1 / 300000.0},
        {134.96298, 477198.867398, 0.0086972, 1 / 56250.0},
        {93.27191, 483202.017538, -0.0036825, 1 / 327270.0},
        {125.04452, -1934.136261, 0.0020708, 1 / 450000.0}};
    double t = p->ephemeris_century, psi = 0, epsilon = 0;
    for (int j = 0; j < 5; j++) p->nutation_argument_deg[j] = polynomial(argument[j], 4, t);
    for (int i = 0; i < NUTATION_TERMS; i++) {
        const NutationTerm *term = &nutation_terms[i];
        double sum = 0;
        for (int j = 0; j < 5; j++) sum += term->multiple[j] * p->nutation_argument_deg[j];
        psi += (term->psi + term->psi_rate * t) * sin_deg(sum);
        epsilon += (term->epsilon + term->epsilon_rate * t) * cos_deg(sum);
    }
    p->nutation_longitude_deg = psi / 36e6;
    p->nutation_obliquity_deg = epsilon / 36e6;
}

/* 3.5 to 3.8: obliquity, aberration, sidereal time. */
static void orient(SunPosition *p)
{
    static const double mean[11] = {84381.448, -4680.93, -1.55, 1999.25, -51.38, -249.67,
                                    -39.05, 7.12, 27.87, 5.79, 2.45};
    double days = p->julian_day - J2000, t = p->julian_century;
    p->mean_obliquity_arcsec = polynomial(mean, 11, p->ephemeris_millennium / 10);
    p->obliquity_deg = p->mean_obliquity_arcsec / 3600 + p->nutation_obliquity_deg;
    p->aberration_deg = -20.4898 / (3600 * p->distance_au);
    p->apparent_longitude_deg = p->geocentric_longitude_deg + p->nutation_longitude_deg +
                                p->aberration_deg;
    p->mean_sidereal_deg = turn_deg(280.46061837 + 360.98564736629 * days +
                                    t * t * (0.000387933 - t / 38710000));
    p->apparent_sidereal_deg = p->mean_sidereal_deg +
                               p->nutation_longitude_deg * cos_deg(p->obliquity_deg);
}

/* 3.9 and 3.10: geocentric right ascension and declination. */
static void equatorial(SunPosition *p)
{
    double lambda = radians_from_degrees(p->apparent_longitude_deg);
    double beta = radians_from_degrees(p->geocentric_latitude_deg);
    double se = sin_deg(p->obliquity_deg), ce = cos_deg(p->obliquity_deg);
    p->right_ascension_deg = turn_deg(degrees_from_radians(
        atan2_d(sin_d(lambda) * ce - tan_d(beta) * se, cos_d(lambda))));
    p->declination_deg = degrees_from_radians(asin_d(sin_d(beta) * ce +
                                                   cos_d(beta) * se * sin_d(lambda)));
}

/* 3.11 to 3.13: as seen from the place and not from the Earth's centre. */
static void topocentric(SunPosition *p, const SkyPlace *place)
{
    double latitude = radians_from_degrees(place->latitude_deg);
    p->hour_angle_deg = turn_deg(p->apparent_sidereal_deg + place->longitude_deg -
                                 p->right_ascension_deg);
    p->parallax_deg = 8.794 / (3600 * p->distance_au);
    double reduced = atan2_d(EARTH_FLATNESS * sin_d(latitude), cos_d(latitude));
    double height = place->altitude_m / EARTH_RADIUS_M, xi = sin_deg(p->parallax_deg);
    double x = cos_d(reduced) + height * cos_d(latitude);
    double y = EARTH_FLATNESS * sin_d(reduced) + height * sin_d(latitude);
    double h = radians_from_degrees(p->hour_angle_deg);
    double delta = radians_from_degrees(p->declination_deg);
    double nearer = cos_d(delta) - x * xi * cos_d(h);
    double shift = atan2_d(-x * xi * sin_d(h), nearer);
    p->parallax_right_ascension_deg = degrees_from_radians(shift);
    p->topocentric_right_ascension_deg = p->right_ascension_deg + degrees_from_radians(shift);
    p->topocentric_declination_deg =
        degrees_from_radians(atan2_d((sin_d(delta) - y * xi) * cos_d(shift), nearer));
    p->topocentric_hour_angle_deg = p->hour_angle_deg - degrees_from_radians(shift);
}

/* 3.14 and 3.15, without refraction. */
static void horizontal(SunPosition *p, const SkyPlace *place)
{
    double sl = sin_deg(place->latitude_deg), cl = cos_deg(place->latitude_deg);
    double sd = sin_deg(p->topocentric_declination_deg);
    double cd = cos_deg(p->topocentric_declination_deg);
    double sh = sin_deg(p->topocentric_hour_angle_deg);
    double ch = cos_deg(p->topocentric_hour_angle_deg);
    double sine = sl * sd + cl * cd * ch;
    p->elevation_deg = degrees_from_radians(asin_d(fmax(-1, fmin(1, sine))));
    p->azimuth_deg =
        turn_deg(180 + degrees_from_radians(atan2_d(sh * cd, ch * cd * sl - sd * cl)));
}

SunPosition sun_position(double julian_day, double delta_t_s, const SkyPlace *place)
{
    SunPosition p = {.julian_day = julian_day};
    p.julian_century = (julian_day - J2000) / 36525;
    p.ephemeris_day = julian_day + delta_t_s / 86400;
    p.ephemeris_century = (p.ephemeris_day - J2000) / 36525;
    p.ephemeris_millennium = p.ephemeris_century / 10;
    heliocentric(&p);
    nutate(&p);
    orient(&p);
    equatorial(&p);
    topocentric(&p, place);
    horizontal(&p, place);
    return p;
}

/* ---- the air and the horizon ------------------------------------------------------------- */

double sun_refraction_deg(double true_elevation_deg, double pressure_mbar, double celsius)
{
    double e = fmax(true_elevation_deg, -1);
    double bend = pressure_mbar / 1010 * 283 / (273 + celsius) * 1.02 /
                  (60 * tan_d(radians_from_degrees(e + 10.3 / (e + 5.11))));
    double fade = fmax(0, fmin(1, (true_elevation_deg + 5) / 4));
    return fmax(0, bend) * fade;
}

void standard_atmosphere(double altitude_m, double *pressure_mbar, double *celsius)
{
    /* troposphere to 11 km with -6.5 K/km, then isothermal */
    double low = fmax(-500, fmin(altitude_m, 11000)), kelvin = 288.15 - 0.0065 * low;
    double pressure = 1013.25 * pow_d(kelvin / 288.15, 5.255876);
    if (altitude_m > 11000) pressure *= exp_d(-(fmin(altitude_m, 20000) - 11000) / 6341.62);
    *pressure_mbar = pressure;
    *celsius = kelvin - 273.15;
}

double horizon_dip_deg(double altitude_m)
{
    const double radius = 6371000;
    return degrees_from_radians(acos_d(radius / (radius + fmax(0, altitude_m))));
}
