/* SPDX-License-Identifier: Apache-2.0 */
/* The formulas of the eye: published values, and laws. */
#include "fixture.h"

#include <string.h>

#include "base/count.h"
#include "base/units.h"
#include "vision/discomfort.h"
#include "vision/eye_spread.h"
#include "vision/grey_steps.h"

/* ---- point spread ------------------------------------------------------------------------ */

TEST(eye_spread_has_its_values) {
    static const double ROWS[][2] = {{0.1, 11685},    {0.5, 135.95},   {1, 19.267},
                                     {2, 2.9451},     {5, 0.29524},    {10, 0.061606},
                                     {30, 0.0077692}, {60, 0.0032553}, {90, 0.0024829}};
    for (int i = 0; i < COUNT_OF(ROWS); i++)
        assert_close(eye_spread_at(ROWS[i][0], (HumanEye){25, 0.5}), ROWS[i][1], 4e-5);
    assert_true(isnan(eye_spread_at(-0.1, (HumanEye){25, 0.5})));
    assert_true(isnan(eye_spread_at(90.1, (HumanEye){25, 0.5})));
}

/* Over rings whose ends rise by 1 %, by the midpoint. */
static double ring_integral(HumanEye eye) {
    double sum = 0, inner = 0;
    for (double outer = 1e-5; inner < 90; outer *= 1.01) {
        double end = outer < 90 ? outer : 90;
        double ring = cos(radians_from_degrees(inner)) - cos(radians_from_degrees(end));
        sum += 2 * PI * eye_spread_at((inner + end) / 2, eye) * ring;
        inner = end;
    }
    return sum;
}

/* The published constants: what their sum has above one is not divided away. */
TEST(eye_spread_has_the_published_integral) {
    static const struct {
        HumanEye eye;
        double integral;
    } ROWS[] = {{{24, 0}, 1.0049},   {{24, 0.5}, 1.0316}, {{24, 1}, 1.0583},  {{25, 0.5}, 1.0317},
                {{60, 0.5}, 1.0502}, {{70, 0.5}, 1.0664}, {{75, 1.2}, 1.1688}};
    for (int i = 0; i < COUNT_OF(ROWS); i++)
        assert_near(ring_integral(ROWS[i].eye), ROWS[i].integral, 2e-4);
}

/* CIE 146:2002, the general equation as it is commonly quoted (J. J. Vos, Clin. Exp. Optom. 86
 * (2003) 363), 0.1 to 100 degrees. */
static double disability_glare(double angle_deg, HumanEye eye) {
    double t = angle_deg, p = eye.pigment, age = 1 + pow(eye.age_years / 62.5, 4);
    return 10 / (t * t * t) + (5 / (t * t) + 0.1 * p / t) * age + 0.0025 * p;
}

/* Two fits of the same measurements. */
TEST(glare_and_spread_agree) {
    for (double age = 20; age <= 80; age += 15) {
        for (double angle = 1; angle <= 90; angle *= 1.2) {
            HumanEye eye = {age, 0.5};
            double bound = angle < 2 ? 0.30 : 0.20;
            assert_close(eye_spread_at(angle, eye), disability_glare(angle, eye), bound);
        }
    }
}

/* Beside the core, which scattering takes light from. */
TEST(older_and_lighter_eyes_scatter_more) {
    for (double angle = 0.5; angle <= 90; angle *= 1.3) {
        assert_true(eye_spread_at(angle, (HumanEye){70, 0.5}) >
                    eye_spread_at(angle, (HumanEye){30, 0.5}));
        assert_true(eye_spread_at(angle, (HumanEye){30, 1.2}) >
                    eye_spread_at(angle, (HumanEye){30, 0.5}));
    }
}

/* ---- position index ---------------------------------------------------------------------- */

TEST(position_index_has_its_values) {
    static const double SIGMAS[] = {10, 20, 30, 50}, TAUS[] = {0, 45, 90};
    static const double VALUES[3][4] = {{1.4345, 2.1460, 3.3481, 9.2442},
                                        {1.2655, 1.6905, 2.3833, 5.5706},
                                        {1.0898, 1.2386, 1.4681, 2.3396}};
    for (int i = 0; i < 12; i++)
        assert_near(position_index_above(TAUS[i / 4], SIGMAS[i % 4]), VALUES[i / 4][i % 4], 5.1e-5);
    assert_close(position_index_below(degrees_from_radians(atan(0.5))), 1.4, 1e-12);
    assert_close(position_index_below(degrees_from_radians(atan(1.0))), 2.2, 1e-12);
    assert_close(position_index_below(degrees_from_radians(atan(5.0))), 4.6, 1e-12);
    assert_near(position_index_above(0, 90), POSITION_INDEX_MAX, 0);
    assert_near(position_index_above(30, 0), 1, 0);
    assert_near(position_index_below(0), 1, 0);
}

/* The two formulas do not meet: neither is bent to. */
TEST(position_index_jumps_at_the_horizontal) {
    static const double ROWS[][3] = {
        {10, 1.0898, 1.1411}, {20, 1.2386, 1.2912}, {30, 1.4681, 1.4619}, {50, 2.3396, 2.4301}};
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        double sigma = radians_from_degrees(ROWS[i][0]), s = sin(sigma), c = cos(sigma);
        assert_close(position_index(s, 0, c), ROWS[i][1], 4e-5);
        assert_close(position_index(-s, 1e-9, c), ROWS[i][1], 4e-5);
        assert_close(position_index(s, -1e-9, c), ROWS[i][2], 4e-5);
    }
    double before = position_index_below(degrees_from_radians(atan(0.5999999)));
    double after = position_index_below(degrees_from_radians(atan(0.6000001)));
    assert_near(before, 1.48, 1e-5);
    assert_near(after, 1.72, 1e-5);
}

TEST(position_index_of_a_direction) {
    double s = radians_from_degrees(20);
    assert_close(position_index(0, sin(s), cos(s)), 2.1460, 3e-5);
    assert_close(position_index(0, 7 * sin(s), 7 * cos(s)), 2.1460, 3e-5);
    double diagonal = sin(s) / sqrt(2);
    assert_close(position_index(diagonal, diagonal, cos(s)), 1.6905, 3e-5);
    assert_close(position_index(-diagonal, diagonal, cos(s)), 1.6905, 3e-5);
    assert_close(position_index(0, -sin(s), cos(s)), 1 + 0.8 * tan(s), 1e-12);
    assert_near(position_index(0, 0, 1), 1, 0);
    assert_near(position_index(0, 0.1, -1), POSITION_INDEX_MAX, 0);
    assert_near(position_index(1, 0.1, 0), POSITION_INDEX_MAX, 0);
}

/* ---- discomfort -------------------------------------------------------------------------- */

TEST(ugr_has_its_value) {
    const GlareSource one = {5000, 0.01, 1.5}, two[] = {one, one};
    assert_close(discomfort_ugr(40, &one, 1), 22.7331, 3e-6);
    assert_close(discomfort_ugr(40, two, 2), 22.7331 + 8 * log10(2), 3e-6);
    assert_true(discomfort_ugr(40, NULL, 0) == -INFINITY);
    assert_true(isnan(discomfort_ugr(0, &one, 1)));
    assert_true(isnan(discomfort_ugr(40, &(GlareSource){5000, 0.01, 0.5}, 1)));
}

TEST(dgp_has_its_values) {
    const GlareSource source = {1e5, 0.001, 1.5};
    assert_close(discomfort_dgp(3000, NULL, 0), 0.335100, 2e-6);
    assert_close(discomfort_dgp(3000, &source, 1), 0.370051, 2e-6);
    assert_close(discomfort_dgp(200, NULL, 0), 0.17074, 4e-6);
    assert_close(discomfort_dgp(200, NULL, 0) * discomfort_dgp_low_light(200), 0.117806, 4e-6);
    assert_near(discomfort_dgp(50000, NULL, 0), 1, 0);
    assert_true(isnan(discomfort_dgp(0, NULL, 0)));
    assert_true(isnan(discomfort_dgp(3000, &(GlareSource){1e5, 0.001, 0.9}, 1)));
}

/* Hopkinson's formula as evalglare has it, worked by hand: 1.5^2 = 2.25. */
TEST(dgi_has_its_value) {
    const GlareSource one = {5000, 0.01, 1.5}, two[] = {one, one};
    double term = 0.478 * pow(5000, 1.6) * pow(0.01 / 2.25, 0.8) / (40 + 0.07 * 0.1 * 5000);
    assert_close(discomfort_dgi(40, &one, 1), 10 * log10(term), 1e-12);
    assert_close(discomfort_dgi(40, &one, 1), 18.40973, 3e-5);
    assert_close(discomfort_dgi(40, two, 2), 10 * log10(2 * term), 1e-12);
    assert_true(discomfort_dgi(40, NULL, 0) == -INFINITY);
    assert_true(isfinite(discomfort_dgi(0, &one, 1)));
}

TEST(figures_say_why_one_is_none) {
    const GlareSettings set = GLARE_SETTINGS_DEFAULT;
    const GlareSource one = {5000, 0.01, 1.5};
    GlareFigures all = discomfort_figures(&set, &(GlareView){&one, 1, 45, 40 * PI});
    GlareFigures sources = discomfort_figures(&set, &(GlareView){&one, 1, 45, 0});
    GlareFigures even = discomfort_figures(&set, &(GlareView){NULL, 0, 0, 200});
    GlareFigures dark = discomfort_figures(&set, &(GlareView){NULL, 0, 0, 0});
    assert_int_equal(all.none, GLARE_HAS_UGR);
    assert_null(discomfort_none_words(all.none));
    assert_close(all.ugr, 22.7331, 3e-6);
    assert_close(all.dgi, 18.40973, 3e-5);
    assert_int_equal(sources.none, GLARE_NO_BACKGROUND);
    assert_true(isnan(sources.ugr) && sources.dgp > 0 && sources.dgi > 0);
    assert_int_equal(even.none, GLARE_NO_SOURCE);
    assert_close(even.dgp, 0.117806, 4e-6);
    assert_true(isnan(even.ugr) && isnan(even.dgi));
    assert_int_equal(dark.none, GLARE_NO_LIGHT);
    assert_true(isnan(dark.dgp));
    assert_non_null(discomfort_none_words(sources.none));
}

TEST(figures_heed_their_settings) {
    GlareSettings set = GLARE_SETTINGS_DEFAULT;
    const GlareSource one = {5000, 0.01, 1.5};
    const GlareView view = {&one, 1, 45, 155};
    double with = discomfort_figures(&set, &view).dgp;
    assert_near(glare_threshold(&set, 300), 2000, 0);
    set.low_light = false;
    set.task_factor = 5;
    assert_close(discomfort_figures(&set, &view).dgp * discomfort_dgp_low_light(200), with, 1e-12);
    assert_near(glare_threshold(&set, 300), 1500, 0);
}

/* Pieces of one luminance are their source: nothing but the index changes over it. */
TEST(a_source_is_the_sum_of_its_pieces) {
    GlareSum sum = {0}, one = {0};
    double s = radians_from_degrees(20), t = radians_from_degrees(40);
    glare_sum_add(&sum, 300, 0.01, 0, sin(s), cos(s));
    glare_sum_add(&sum, 900, 0.02, sin(t), 0, cos(t));
    glare_sum_add(&sum, 1e9, 0.02, 0, 0.6, -0.8);
    GlareSource source = glare_sum_source(&sum);
    double p = position_index(0, sin(s), cos(s)), q = position_index(sin(t), 0, cos(t));
    assert_close(source.solid_angle_sr, 0.03, 1e-12);
    assert_close(source.luminance_cd_m2, 700, 1e-12);
    assert_close(pow(source.position_index, -2) * 0.03, 0.01 / (p * p) + 0.02 / (q * q), 1e-12);
    assert_close(sum.lx, 3 * cos(s) + 18 * cos(t), 1e-12);
    glare_sum_add(&one, 700, 0.01, 0, sin(s), cos(s));
    assert_close(glare_sum_source(&one).position_index, p, 1e-12);
}

TEST(dgp_is_less_in_low_light) {
    static const double ROWS[][2] = {{100, 0.168}, {200, 0.690}, {300, 0.961}, {380, 0.994}};
    for (int i = 0; i < COUNT_OF(ROWS); i++)
        assert_near(discomfort_dgp_low_light(ROWS[i][0]), ROWS[i][1], 5e-4);
    assert_near(discomfort_dgp_low_light(999.999), 1, 1e-8); /* no step at 1000 lx */
    assert_near(discomfort_dgp_low_light(1000), 1, 0);
    assert_near(discomfort_dgp_low_light(1e5), 1, 0);
}

/* ---- thresholds -------------------------------------------------------------------------- */

TEST(contrast_sensitivity_has_its_values) {
    static const double U[] = {1, 4, 8, 16, 30}, L[] = {100, 1, 1000};
    static const double VALUES[3][5] = {{410.67, 633.74, 426.12, 169.38, 30.60},
                                        {277.47, 172.37, 84.83, 27.87, 3.37},
                                        {415.43, 724.77, 564.79, 242.64, 46.18}};
    for (int i = 0; i < 15; i++)
        assert_near(contrast_sensitivity(U[i % 5], L[i / 5], 10), VALUES[i / 5][i % 5], 6e-3);
    assert_true(isnan(contrast_sensitivity(0, 100, 10)));
    assert_true(isnan(contrast_sensitivity(4, 0, 10)));
    assert_true(isnan(contrast_sensitivity(4, 100, -1)));
}

TEST(grey_steps_have_their_values) {
    static const double ROWS[][2] = {{1, 0.04998},     {100, 1.85083},   {200, 8.21785},
                                     {500, 119.13179}, {800, 933.18743}, {1023, 3993.330}};
    for (int i = 0; i < COUNT_OF(ROWS); i++)
        assert_close(grey_steps_luminance(ROWS[i][0]), ROWS[i][1], 4e-5);
    assert_near(grey_steps_of(grey_steps_luminance(200)), 200.021, 5e-4);
}

TEST(grey_steps_go_there_and_back) {
    double previous = 0;
    for (int step = 1; step <= 1023; step++) {
        double luminance = grey_steps_luminance(step);
        assert_true(luminance > previous);
        assert_near(grey_steps_of(luminance), step, 0.1);
        previous = luminance;
    }
    for (double l = 0.05; l < 3970; l *= 1.01)
        assert_true(grey_steps_of(l * 1.005) > grey_steps_of(l));
    assert_near(grey_steps_between(8.21785, 119.13179), 300, 0.1);
    assert_near(grey_steps_between(119.13179, 8.21785), 300, 0.1);
    assert_near(grey_steps_between(5, 5), 0, 0);
}

TEST(grey_steps_keep_their_range) {
    assert_true(isnan(grey_steps_luminance(0.9)) && isnan(grey_steps_luminance(1024)));
    assert_true(isnan(grey_steps_of(0.049)) && isnan(grey_steps_of(4000)));
    assert_true(isnan(grey_steps_of(0)) && isnan(grey_steps_between(10, 5000)));
    assert_true(isfinite(grey_steps_of(0.05)) && isfinite(grey_steps_of(3993)));
}

/* ---- whose eye --------------------------------------------------------------------------- */

TEST(eyes_are_read) {
    HumanEye eye = {0, 0};
    assert_done(human_eye_parse("60", &eye, &err));
    assert_true(eye.age_years == 60 && eye.pigment == HUMAN_EYE_PIGMENT_USUAL);
    assert_done(human_eye_parse("24.5,1.2", &eye, &err));
    assert_true(eye.age_years == 24.5 && eye.pigment == 1.2);
}

TEST(what_is_no_eye_is_refused) {
    static const char *const WRONG[] = {"",       "old",    "9",    "101",      "40,",
                                        "40,1.3", "40,-1",  "40 ",  "40,0.5,1", "-40",
                                        "nan",    "40,nan", "0x20", "4e9",      "+40"};
    for (int i = 0; i < COUNT_OF(WRONG); i++) {
        HumanEye eye = {1, 2};
        assert_false(human_eye_parse(WRONG[i], &eye, why()));
        assert_true(eye.age_years == 1 && eye.pigment == 2);
        assert_int_equal(why()->code, ERROR_USAGE);
        assert_true(strstr(why()->text, WRONG[i]) == why()->text);
        assert_non_null(strstr(why()->text, "required: AGE or AGE,PIGMENT: 10 to 100 years"));
    }
}

TEST_PROGRAM(NULL, NULL)
