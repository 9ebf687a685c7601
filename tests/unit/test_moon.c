/* SPDX-License-Identifier: Apache-2.0 */
/* Where the moon stands, how much of it is lit, and what light it sends. */
#include "sky_fixture.h"
#include "sky/moon_light.h"
#include "sky/moon_position.h"
#include "sky/sun_disc.h"

static const SkyPlace anywhere = {48.14, 11.58, 520};

static double day_of(const char *text) {
    SkyTime time = moment(text);
    return sky_julian_day(&time);
}

static MoonPosition moon_at(const char *text, SkyPlace place) {
    double day = day_of(text);
    return moon_position(day, sky_delta_t_s(day), &place);
}

/* ---- where it stands --------------------------------------------------------------------- */

/* Meeus, Astronomical Algorithms, example 47.a: 1992 April 12, 0h dynamical time. */
TEST(the_published_example_holds) {
    MoonPosition p = moon_position(2448724.5 - 59.0 / 86400, 59, &anywhere);
    assert_float_equal(p.longitude_deg, 133.162655, 1e-6);
    assert_float_equal(p.latitude_deg, -3.229126, 1e-6);
    assert_float_equal(p.distance_km, 368409.7, 0.05);
    assert_float_equal(p.apparent_longitude_deg, 133.167265, 2e-5);
    assert_float_equal(p.right_ascension_deg, 134.688470, 3e-5);
    assert_float_equal(p.declination_deg, 13.768368, 2e-5);
}

/* Almanacs define the phases by the excess of the moon's apparent longitude over the sun's;
 * their minutes are rounded, and the moon gains 0.0085 degrees a minute. */
TEST(published_phases_come_in_their_minute) {
    static const struct {
        const char *when;
        double excess;
    } phase[] = {{"2019-01-06T01:28Z", 0},   {"2019-01-14T06:46Z", 90},  {"2019-01-21T05:16Z", 180},
                 {"2019-01-27T21:10Z", 270}, {"2019-07-02T19:16Z", 0},   {"2019-07-16T21:38Z", 180},
                 {"2019-11-04T10:23Z", 90},  {"2019-12-26T05:13Z", 0},   {"2024-01-25T17:54Z", 180},
                 {"2024-04-08T18:21Z", 0},   {"2000-01-21T04:40Z", 180}, {"2000-07-31T02:25Z", 0}};
    for (size_t i = 0; i < sizeof phase / sizeof *phase; i++) {
        double day = day_of(phase[i].when), delta = sky_delta_t_s(day);
        MoonPosition p = moon_position(day, delta, &anywhere);
        SunPosition s = sun_position(day, delta, &anywhere);
        double off =
            remainder(p.apparent_longitude_deg - s.apparent_longitude_deg - phase[i].excess, 360);
        if (!(fabs(off) < 0.013)) fail_msg("%s: %.4f degrees off", phase[i].when, off);
    }
}

/* Greatest eclipse (NASA's catalogues): there and then the moon stands before the sun. */
TEST(total_eclipses_of_the_sun_are_seen_where_they_were) {
    static const struct {
        const char *when;
        SkyPlace place;
    } eclipse[] = {{"1999-08-11T11:03:07Z", {45.1, 24.3, 0}},
                   {"2017-08-21T18:25:32Z", {36.97, -87.67, 0}},
                   {"2024-04-08T18:17:18Z", {25.29, -104.14, 0}},
                   {"2024-04-08T18:42:40Z", {32.78, -96.8, 0}}, /* Dallas */
                   {"2026-08-12T17:45:51Z", {65.22, -25.23, 0}}};
    for (size_t i = 0; i < sizeof eclipse / sizeof *eclipse; i++) {
        MoonPosition p = moon_at(eclipse[i].when, eclipse[i].place);
        double moon = degrees_from_radians(moon_angular_radius(p.topocentric_km));
        double sun = degrees_from_radians(sun_angular_radius(p.sun_moon_au));
        assert_true(moon > sun && p.sun_elevation_deg > 0);
        if (!(p.elongation_deg < moon - sun + 0.008))
            fail_msg("%s: %.4f degrees apart", eclipse[i].when, p.elongation_deg);
        assert_true(p.illuminated < 1e-4);
    }
}

/* In the umbra: within 0.45 degrees of the point opposite the sun, from the Earth's centre. */
TEST(total_eclipses_of_the_moon_stand_opposite_the_sun) {
    static const char *const when[] = {"2018-07-27T20:21:44Z", "2019-01-21T05:12:16Z",
                                       "2022-11-08T10:59:11Z", "2025-03-14T06:58:43Z"};
    for (size_t i = 0; i < sizeof when / sizeof *when; i++) {
        double day = day_of(when[i]), delta = sky_delta_t_s(day);
        MoonPosition p = moon_position(day, delta, &anywhere);
        SunPosition s = sun_position(day, delta, &anywhere);
        double excess = p.apparent_longitude_deg - s.apparent_longitude_deg;
        double along = remainder(excess - 180, 360);
        assert_true(hypot(along, p.latitude_deg) < 0.45);
        assert_true(p.illuminated > 0.9998);
    }
}

/* Seen from the place it stands lower by nearly the horizontal parallax times the cosine of
 * its elevation, and nearer by what the place is closer to it. */
TEST(the_place_shifts_the_moon_by_its_parallax) {
    for (int i = 0; i < 2000; i++) {
        SkyPlace place = {180 * random_unit() - 90, 360 * random_unit() - 180, 0};
        double day = 2451545 + 20000 * (random_unit() - 0.5);
        double delta = sky_delta_t_s(day);
        MoonPosition p = moon_position(day, delta, &place);
        SunPosition s = sun_position(day, delta, &place);
        double h = radians_from_degrees(s.apparent_sidereal_deg + place.longitude_deg -
                                        p.right_ascension_deg);
        double l = radians_from_degrees(place.latitude_deg);
        double d = radians_from_degrees(p.declination_deg);
        double sine = sin(l) * sin(d) + cos(l) * cos(d) * cos(h);
        double cosine = sqrt(1 - sine * sine);
        double ratio = 6371.0 / p.distance_km; /* a sphere: 0.3 % of the parallax, and its
                                                  vertical is 0.2 degrees off of a degree */
        double lower = degrees_from_radians(atan2(ratio * cosine, 1 - ratio * sine));
        double geocentric = degrees_from_radians(asin(sine));
        assert_true(fabs(geocentric - lower - p.elevation_deg) < 0.012);
        assert_true(fabs(p.topocentric_km / p.distance_km -
                         sqrt(1 - 2 * ratio * sine + ratio * ratio)) < 1.5e-4);
        assert_in(p.distance_km, 356350, 406800);
        assert_in(fabs(p.latitude_deg), 0, 5.35);
    }
}

/* Sun, moon and observer make a triangle. */
TEST(phase_and_elongation_agree) {
    for (int i = 0; i < 500; i++) {
        double day = 2451545 + 20000 * (random_unit() - 0.5);
        MoonPosition p = moon_position(day, sky_delta_t_s(day), &anywhere);
        SunPosition s = sun_position(day, sky_delta_t_s(day), &anywhere);
        double au = p.topocentric_km / ASTRONOMICAL_UNIT_KM;
        double third = 180 - p.phase_angle_deg - p.elongation_deg; /* at the sun */
        assert_true(third > -1e-9 && third < 0.17);
        assert_true(fabs(sin(radians_from_degrees(third)) * p.sun_moon_au -
                         sin(radians_from_degrees(p.elongation_deg)) * au) < 1e-6);
        assert_true(fabs(p.sun_moon_au - s.distance_au) < 0.0028);
        assert_true(fabs(p.illuminated - pow(cos(radians_from_degrees(p.phase_angle_deg) / 2), 2)) <
                    1e-12);
    }
}

/* ---- its light --------------------------------------------------------------------------- */

static double ratio_at(double phase_deg, double km, double au) {
    Curve ratio;
    moon_over_sun(&(MoonDistances){phase_deg, km, au}, &ratio);
    return (double)ratio.value[551 - CURVE_FIRST_NM];
}

TEST(moonlight_falls_with_phase_and_distance) {
    double full = ratio_at(0, 384400, 1);
    assert_in(full * 133000, 0.30, 0.35); /* lx above the air */
    assert_in(ratio_at(90, 384400, 1) / full, 0.08, 0.12);
    for (int a = 30; a <= 150; a += 30) { /* Allen's magnitudes */
        double fainter = 0.026 * a + 4e-9 * pow(a, 4);
        assert_close(ratio_at(a, 384400, 1) / full, pow(10, -0.4 * fainter), 1e-5);
    }
    assert_close(ratio_at(40, 384400 * 0.93, 1) * 0.93 * 0.93, ratio_at(40, 384400, 1), 1e-6);
    assert_close(ratio_at(40, 384400, 1.01) * 1.01 * 1.01, ratio_at(40, 384400, 1), 1e-6);
    for (int a = 1; a <= 180; a++) assert_true(ratio_at(a, 384400, 1) < ratio_at(a - 1, 384400, 1));
}

/* B - V: 445 and 551 nm, 0.27 mag more than the sun's. */
TEST(moonlight_is_redder_than_sunlight) {
    Curve ratio;
    moon_over_sun(&(MoonDistances){30, 384400, 1}, &ratio);
    double b = (double)ratio.value[445 - CURVE_FIRST_NM];
    double v = (double)ratio.value[551 - CURVE_FIRST_NM];
    assert_float_equal(2.5 * log10(v / b), 0.27, 0.005);
    for (int i = 1; i < CURVE_COUNT; i++) assert_true(ratio.value[i] > ratio.value[i - 1]);
}

TEST(the_disc_keeps_its_light_and_is_dark_beyond_the_terminator) {
    for (int a = 0; a <= 170; a += 10) {
        double phase = radians_from_degrees(a), sum = 0;
        MoonDisc disc = moon_disc(phase);
        int steps = 1000, lit = 0, inside = 0, columns = 4 * steps;
        for (int j = 0; j < steps; j++)
            for (int i = 0; i < columns; i++) {
                double x = 2 * (i + 0.5) / columns - 1, y = 2 * (j + 0.5) / steps - 1;
                if (x * x + y * y >= 1) continue;
                float value = moon_disc_shade(&disc, (float)x, (float)(x * x + y * y));
                double edge = -sqrt(1 - y * y) * cos(phase); /* the terminator's ellipse */
                if (fabs(x - edge) > 1e-3) assert_int_equal(value > 0, x > edge);
                sum += (double)value;
                lit += value > 0;
                inside++;
            }
        assert_close(sum / inside, 1, 5e-3);
        assert_float_equal((double)lit / inside, 0.5 * (1 + cos(phase)), 1e-3);
    }
    MoonDisc full = moon_disc(0);
    for (int i = 0; i < 100; i++)
        assert_close((double)moon_disc_shade(&full, 0, (float)i / 100), 1, 5e-5);
}

TEST_PROGRAM(NULL, NULL)
