/* SPDX-License-Identifier: Apache-2.0 */
/* Threshold increment and mesopic luminance, against values computed by themselves. */
#include "check.h"

#include "base/count.h"
#include "base/units.h"
#include "vision/road_glare.h"

static void assert_share(double found, double required, double relative) {
    if (!(fabs(found / required - 1) <= relative))
        fail_msg("found %.9g, required: %.9g within %g", found, required, relative);
}

/* ---- threshold increment ----------------------------------------------------------------- */

/* A screen of 0.30 x 0.17 m, 0.75 m away and 25 degrees off the line of sight, as one small
 * source, above a road of 0.3 cd/m2. */
static double increment_of_screen(double cd_m2, double age_years) {
    double lux = cd_m2 * 0.30 * 0.17 / (0.75 * 0.75) * cos(radians_from_degrees(25));
    return road_threshold_increment(lux * road_veil_at(25, age_years), 0.3);
}

TEST(a_screen_beside_the_road_increments_the_threshold_as_published) {
    static const struct {
        double cd_m2, at_25, at_70;
    } rows[] = {{20, 4.5, 9.9}, {50, 11.3, 24.7}, {100, 22.5, 49.4}};
    for (int i = 0; i < COUNT_OF(rows); i++) {
        assert_share(increment_of_screen(rows[i].cd_m2, 25), rows[i].at_25, 0.005);
        assert_share(increment_of_screen(rows[i].cd_m2, 70), rows[i].at_70, 0.005);
    }
    assert_share(increment_of_screen(50, 25), 11.26, 0.0005);
    assert_share(increment_of_screen(50, 70), 24.68, 0.001);
}

TEST(the_veil_has_its_two_branches) {
    assert_share(road_veil_at(1.5, 62.5), 10 / 3.375 + 10 / 2.25, 1e-14);
    assert_share(road_veil_at(0.1, 0), 10 / 0.001 + 500, 1e-12);
    assert_share(road_veil_at(nextafter(1.5, 2), 66.4), 2 * 9.86 / 2.25, 1e-12);
    assert_share(road_veil_at(90, 0), 9.86 / 8100, 1e-14);
    assert_share(road_veil_at(nextafter(1.5, 2), 25) / road_veil_at(1.5, 25), 0.8528, 0.001);
}

TEST(no_veil_is_known_outside_its_range) {
    assert_true(isnan(road_veil_at(0.0999, 50)));
    assert_true(isnan(road_veil_at(90.001, 50)));
    assert_true(isnan(road_veil_at(10, -1)));
    assert_true(isnan(road_veil_at((double)NAN, 50)));
}

TEST(the_increment_has_a_branch_of_bright_roads) {
    assert_share(road_threshold_increment(1, 1), 65, 1e-14);
    assert_share(road_threshold_increment(1, 5), 65 / pow(5, 0.8), 1e-14);
    assert_share(road_threshold_increment(1, nextafter(5, 6)), 95 / pow(5, 1.05), 1e-14);
    assert_share(road_threshold_increment(2, 10), 190 / pow(10, 1.05), 1e-14);
    assert_share(road_threshold_increment(1, 0.05), 65 / pow(0.05, 0.8), 1e-14);
    assert_true(isnan(road_threshold_increment(1, nextafter(0.05, 0))));
    assert_true(isnan(road_threshold_increment(-1, 1)));
    assert_true(isnan(road_threshold_increment(1, INFINITY)));
    assert_true(road_threshold_increment(0, 1) == 0);
}

TEST(the_veil_of_an_increment_makes_it) {
    static const double roads[] = {0.05, 0.3, 1, 5, 5.01, 20};
    for (int i = 0; i < COUNT_OF(roads); i++) {
        double veil = road_veil_of_increment(15, roads[i]);
        assert_share(road_threshold_increment(veil, roads[i]), 15, 1e-14);
    }
    assert_true(isnan(road_veil_of_increment(15, 0.04)));
}

/* ---- mesopic luminance ------------------------------------------------------------------- */

TEST(mesopic_luminance_is_as_published) {
    static const struct {
        double s_p, at[3]; /* 0.01, 0.1 and 1 cd/m2 */
    } rows[] = {{0.65, {0.00687, 0.08731, 0.96081}},
                {1.4, {0.01287, 0.11313, 1.04224}},
                {2.2, {0.01771, 0.13654, 1.12003}}};
    static const double photopic[] = {0.01, 0.1, 1};
    for (int i = 0; i < COUNT_OF(rows); i++)
        for (int k = 0; k < 3; k++) {
            double found = road_mesopic_luminance(photopic[k], rows[i].s_p);
            if (fabs(found - rows[i].at[k]) > 0.500001e-5)
                fail_msg("%g cd/m2, S/P %g: %.7f, required: %.5f", photopic[k], rows[i].s_p, found,
                         rows[i].at[k]);
        }
}

/* What iterations end at solves the equation. */
TEST(mesopic_luminance_solves_its_equation) {
    for (double p = 0.006; p < 4.9; p *= 1.3)
        for (double s_p = 0.3; s_p < 4; s_p += 0.3) {
            double found = road_mesopic_luminance(p, s_p), v = 683.0 / 1699;
            double m = fmin(fmax(0.7670 + 0.3334 * log10(found), 0), 1);
            if (found <= 0.005) m = 0;
            if (found >= 5) m = 1;
            double again = (m * p + (1 - m) * p * s_p * v) / (m + (1 - m) * v);
            if (!(fabs(found / again - 1) <= 1e-9))
                fail_msg("%g cd/m2, S/P %g: %.12g, required: %.12g", p, s_p, found, again);
        }
}

TEST(day_and_night_are_its_ends) {
    assert_share(road_mesopic_luminance(5, 1), 5, 1e-12);
    assert_share(road_mesopic_luminance(20, 2.2), 20, 1e-12);
    assert_share(road_mesopic_luminance(0.002, 2.2), 0.0044, 1e-12);
    assert_share(road_mesopic_luminance(0.005, 1), 0.005, 1e-12);
    for (double p = 0.001; p < 10; p *= 2) assert_share(road_mesopic_luminance(p, 1), p, 1e-12);
    assert_true(isnan(road_mesopic_luminance(0, 1)));
    assert_true(isnan(road_mesopic_luminance(1, 0)));
    assert_true(isnan(road_mesopic_luminance((double)NAN, 1)));
}

TEST_PROGRAM(NULL, NULL)
