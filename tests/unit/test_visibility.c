/* SPDX-License-Identifier: Apache-2.0 */
/* Adrian's visibility level: values of the published formula, and where its pieces meet. */
#include "fixture.h"

#include "base/count.h"
#include "vision/visibility.h"

#define AT_LEISURE ((double)INFINITY)

static VisibilityTarget target_at(double cd_m2) {
    return (VisibilityTarget){
        .size_arcmin = 10, .adapted_cd_m2 = cd_m2, .age_years = 25, .glance_s = AT_LEISURE};
}

/* Half of the last digit of four. */
static void assert_four_digits(double value, double want) {
    double unit = pow(10, floor(log10(want)) - 3);
    assert_near(value, want, 0.5 * unit);
}

/* 10 arc minutes, 25 years: lighter, darker, and lighter in a glance of 0.2 s. */
TEST(thresholds_have_their_values) {
    static const double ROWS[][4] = {{0.1, 0.01440, 0.007607, 0.02463},
                                     {1, 0.05024, 0.02964, 0.08152},
                                     {10, 0.2625, 0.1835, 0.4092},
                                     {100, 1.904, 1.726, 2.899},
                                     {1000, 17.22, 16.97, 25.94}};
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        VisibilityTarget lighter = target_at(ROWS[i][0]), darker = lighter, glanced = lighter;
        VisibilityTarget old = lighter;
        darker.is_darker = true;
        glanced.glance_s = 0.2;
        old.age_years = 70;
        assert_four_digits(visibility_threshold(&lighter), ROWS[i][1]);
        assert_four_digits(visibility_threshold(&darker), ROWS[i][2]);
        assert_four_digits(visibility_threshold(&glanced), ROWS[i][3]);
        assert_four_digits(visibility_threshold(&old) / visibility_threshold(&lighter), 2.954);
    }
}

/* The same to all digits that were printed where they are more. */
TEST(thresholds_have_further_digits) {
    VisibilityTarget ten = target_at(10), hundred = target_at(100), kilo = target_at(1000);
    assert_near(visibility_threshold(&ten), 0.26251, 5e-6);
    assert_near(visibility_threshold(&hundred), 1.90363, 5e-6);
    assert_near(visibility_threshold(&kilo), 17.2186, 5e-5);
    ten.is_darker = hundred.is_darker = kilo.is_darker = true;
    assert_near(visibility_threshold(&ten), 0.18347, 5e-6);
    assert_near(visibility_threshold(&hundred), 1.72604, 5e-6);
    assert_near(visibility_threshold(&kilo), 16.9683, 5e-5);
}

/* The dimmest of the three pieces, and the dimmer constant of the polarity factor. */
TEST(dim_pieces_have_their_values) {
    VisibilityTarget dim = target_at(0.001), mid = target_at(0.05);
    double small = pow(10, 0.028 - 3 * 0.173);
    double large = pow(10, -0.891 - 3 * 0.5275 + 9 * 0.0227);
    double af = 36.0 / 2160 + 0.99;
    assert_close(visibility_threshold(&dim), 2.6 * pow(small / 10 + large, 2) * af, 1e-12);
    double l = log10(0.05), k = 0.075 * (l + 1) * (l + 1) + 0.0245;
    double lighter = visibility_threshold(&mid) / af;
    double share = pow(10, -pow(10, -k)) * pow(10, -0.6 * pow(0.05, -0.1488));
    mid.is_darker = true;
    assert_close(visibility_threshold(&mid), (lighter - share / 2.4) * af, 1e-12);
}

/* VL is linear in the difference, and 1 at the threshold. */
TEST(level_counts_thresholds) {
    for (int i = 0; i < 12; i++) {
        VisibilityTarget t = {3 + 11 * i, pow(10, 0.5 * i - 3), 24 + 4 * i, 0.1 + 0.2 * i,
                              i % 2 == 1};
        double threshold = visibility_threshold(&t);
        assert_close(visibility_level(&t, threshold), 1, 1e-14);
        assert_close(visibility_level(&t, -7 * threshold), 7, 1e-14);
    }
}

/* Larger, younger, longer, darker than its background: never harder to see. */
TEST(factors_go_the_right_way) {
    for (double cd_m2 = 1e-4; cd_m2 < 2e4; cd_m2 *= 3) {
        VisibilityTarget t = target_at(cd_m2), large = t, old = t, short_look = t, dark = t;
        double threshold = visibility_threshold(&t);
        large.size_arcmin = 20;
        old.age_years = 60;
        short_look.glance_s = 1.9;
        dark.is_darker = true;
        assert_true(visibility_threshold(&large) < threshold);
        assert_true(visibility_threshold(&old) > threshold);
        assert_true(visibility_threshold(&short_look) > threshold);
        assert_true(visibility_threshold(&dark) <= threshold);
        assert_true(visibility_threshold(&dark) > 0);
    }
}

/* Published as it stands, though nobody sees better the day that he turns 64. */
TEST(age_factor_jumps_at_64) {
    assert_near(visibility_age_factor(64 - 1e-9), 1.9275, 1e-6);
    assert_near(visibility_age_factor(64), 1.900851, 1e-6);
    assert_near(visibility_age_factor(23), 0.997407, 1e-6);
    assert_near(visibility_age_factor(75), 4.341092, 1e-6);
    assert_true(isnan(visibility_age_factor(22.99)));
    assert_true(isnan(visibility_age_factor(75.01)));
    assert_true(isnan(visibility_age_factor(NAN)));
}

/* A glance of 2 s is as good as any longer one: TF does not run out to 1 by itself. */
TEST(glances_count_below_two_seconds) {
    double just_below = visibility_glance_factor(10, 1, 2 - 1e-9);
    assert_true(visibility_glance_factor(10, 1, 2) == 1);
    assert_true(visibility_glance_factor(10, 1, AT_LEISURE) == 1);
    assert_near(just_below, 1.06226, 1e-5);
    assert_close(visibility_glance_factor(10, 1, 0.2) - 1, 10 * (just_below - 1), 1e-6);
    assert_true(isnan(visibility_glance_factor(10, 1, 0)));
    assert_true(isnan(visibility_glance_factor(0, 1, 1)));
    assert_true(isnan(visibility_glance_factor(10, -1, 1)));
}

/* The pieces meet within 2 %, those of the polarity factor at 0.1 cd/m2 exactly. */
TEST(pieces_meet) {
    static const double ENDS[] = {0.00418, 0.6};
    for (int i = 0; i < COUNT_OF(ENDS); i++) {
        VisibilityTarget below = target_at(ENDS[i] * (1 - 1e-9)), above = below;
        above.adapted_cd_m2 = ENDS[i] * (1 + 1e-9);
        assert_close(visibility_threshold(&below), visibility_threshold(&above), 0.02);
    }
    assert_close(visibility_polarity_factor(10, 0.1 * (1 - 1e-12)),
                 visibility_polarity_factor(10, 0.1), 1e-9);
}

TEST(nothing_has_a_threshold_without_light_or_size) {
    VisibilityTarget t = target_at(0);
    assert_true(isnan(visibility_threshold(&t)));
    t = target_at(NAN);
    assert_true(isnan(visibility_threshold(&t)));
    t = target_at(1);
    t.size_arcmin = 0;
    assert_true(isnan(visibility_threshold(&t)));
    t = target_at(1);
    t.glance_s = 0;
    assert_true(isnan(visibility_threshold(&t)));
    t = target_at(1);
    t.age_years = 80;
    assert_true(isnan(visibility_level(&t, 1)));
}

static unsigned doubt(VisibilityDoubt which) {
    return 1u << which;
}

TEST(doubts_are_told) {
    VisibilityTarget t = target_at(1);
    assert_int_equal(visibility_doubts(&t), 0);
    t.age_years = 22;
    assert_int_equal(visibility_doubts(&t), doubt(VISIBILITY_DOUBT_AGE));
    t.age_years = 64.5;
    assert_int_equal(visibility_doubts(&t), doubt(VISIBILITY_DOUBT_JUMP));
    t = target_at(1);
    t.size_arcmin = 61;
    assert_int_equal(visibility_doubts(&t), 0);
    t.glance_s = 0.2;
    assert_int_equal(visibility_doubts(&t), doubt(VISIBILITY_DOUBT_GLANCE));
    t = target_at(0.004);
    assert_int_equal(visibility_doubts(&t), doubt(VISIBILITY_DOUBT_LUMINANCE));
    t.is_darker = true;
    assert_int_equal(visibility_doubts(&t),
                     doubt(VISIBILITY_DOUBT_LUMINANCE) | doubt(VISIBILITY_DOUBT_DARKER));
    assert_true(visibility_polarity_factor(10, 0.004) == 1);
    assert_true(visibility_polarity_factor(10, 0.0041) < 1);
    t = target_at(201);
    assert_int_equal(visibility_doubts(&t), doubt(VISIBILITY_DOUBT_LUMINANCE));
}

TEST_PROGRAM(NULL, NULL)
