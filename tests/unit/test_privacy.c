/* SPDX-License-Identifier: Apache-2.0 */
/* What must not be read: visual security, and its verdict. */
#include "fixture.h"

#include "base/count.h"
#include "base/mathd.h"
#include "review/judge.h"
#include "vision/privacy.h"

/* ---- the formula ------------------------------------------------------------------------- */

/* V and S of white, black and what is reflected; 1/V is the contrast left of white. */
TEST(security_has_its_values) {
    static const double ROWS[][5] = {{1, 0.01, 0.5, 1.5 / 0.99, 0.18},
                                     {1, 0.01, 30, 31 / 0.99, 1.50},
                                     {10, 0.1, 100, 110 / 9.9, 1.05},
                                     {1, 0, 0, 1, 0}};
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        const double *r = ROWS[i];
        double v = privacy_security(r[0], r[1], r[2]);
        double ratio = (r[0] + r[2]) / (r[1] + r[2]);
        assert_close(v, r[3], 1e-15);
        assert_near(log10_d(v), r[4], 0.005);
        assert_near(privacy_s_of_contrast(ratio), log10_d(v), 1e-14);
        assert_near(1 / v, 1 - 1 / ratio, 1e-15);
    }
    assert_near(privacy_security(1, 0.01, 0.5), 1.515, 5e-4);
    assert_near(privacy_security(1, 0.01, 30), 31.3, 0.05);
    assert_near(privacy_security(10, 0.1, 100), 11.1, 0.05);
    assert_near((1 + 0.5) / (0.01 + 0.5), 2.94, 0.005); /* readable at night */
    /* Black next to none: 10 is met from Y = R/9 down. */
    assert_close(privacy_security(0.5 / 9, 0, 0.5), 10, 1e-14);
    assert_near(0.5 / 9, 0.056, 5e-4);
}

TEST(security_has_its_ends) {
    assert_true(isinf(privacy_security(1, 1, 2))); /* no picture */
    assert_true(isinf(privacy_security(1, 2, 0)));
    assert_true(isinf(privacy_security(0, 0, 0))); /* dark altogether */
    assert_true(isnan(privacy_security(-1, 0, 0)));
    assert_true(isnan(privacy_security(1, 0, NAN)));
    assert_true(isinf(privacy_s_of_contrast(1)));
    assert_near(privacy_s_of_contrast(INFINITY), 0, 0);
    assert_true(isnan(privacy_s_of_contrast(0.9)));
    assert_true(isinf(privacy_contrast_of_s(0)));
    assert_near(privacy_contrast_of_s(INFINITY), 1, 0);
    assert_true(isnan(privacy_contrast_of_s(-1)));
    assert_close(privacy_contrast_of_s(SECURITY_OBSCURED), 10.0 / 9, 1e-15);
    for (double ratio = 1.0001; ratio < 1e5; ratio *= 1.7) {
        assert_close(privacy_contrast_of_s(privacy_s_of_contrast(ratio)), ratio, 1e-9 * ratio);
        assert_true(privacy_s_of_contrast(ratio * 1.01) < privacy_s_of_contrast(ratio));
    }
}

/* Of intervals of all three the ends are at corners: least with the most white, the least black
 * and the least reflected. */
TEST(security_is_monotone_in_each) {
    static const double LEVELS[] = {0.2, 1, 7};
    for (int y = 0; y < 3; y++)
        for (int k = 0; k < 3; k++)
            for (int r = 0; r < 3; r++) {
                double white = 10 * LEVELS[y], black = 0.1 * LEVELS[k], light = LEVELS[r];
                double v = privacy_security(white, black, light);
                assert_true(v > 1);
                assert_true(privacy_security(1.1 * white, black, light) < v);
                assert_true(privacy_security(white, 1.1 * black, light) > v);
                assert_true(privacy_security(white, black, 1.1 * light) > v);
                double low = privacy_security(1.1 * white, 0.9 * black, 0.9 * light);
                double high = privacy_security(0.9 * white, 1.1 * black, 1.1 * light);
                for (double part = -0.1; part <= 0.1; part += 0.05) {
                    double inside = privacy_security((1 + part) * white, (1 - part) * black,
                                                     (1 + 0.5 * part) * light);
                    assert_true(low <= inside && inside <= high);
                }
            }
}

/* ---- the verdict ------------------------------------------------------------------------- */

/* White of `white` and black of a hundredth of it, of which so much is known. */
static ReviewCase private_case(double white, double reflected, double doubt) {
    ReviewCase c = {
        .ambient = AMBIENT_NIGHT,
        .must_not_be_read = true,
        .visible_share = 1,
        .height_arcmin = 25,
        .stroke_ratio = 0.15,
        .luminance_cd_m2 = {
            .foreground = white, .background = white / 100, .reflected = reflected, .veil = 3}};
    judge_contrasts(&c, (MeanInterval){reflected * (1 - doubt), reflected * (1 + doubt)});
    return c;
}

static Profile profile_of(const ProfileLimit *limits, int count) {
    return (Profile){.limits = limits,
                     .limit_count = count,
                     .uses_veil = true,
                     .security = {.name = "visual security",
                                  .kind = LIMIT_VISUAL_SECURITY,
                                  .ambients = {true, true, true, true},
                                  .value = 1,
                                  .source = "assumed"}};
}

static ProfileLimit limit_of(LimitKind kind, double value) {
    return (ProfileLimit){.name = "one",
                          .kind = kind,
                          .ambients = {true, true, true, true},
                          .value = value,
                          .source = "a test",
                          .read_in_the_standard = true};
}

static double security(double white, double black, double reflected) {
    return log10_d(privacy_security(white, black, reflected));
}

/* S with its interval is the formula's of what is emitted and reflected; a veil does not
 * count. The table's three rows: readable, and twice obscured. */
ARENA_TEST(its_figure_is_the_formula_s) {
    static const double ROWS[][2] = {{1, 0.5}, {1, 30}, {10, 100}};
    const Profile profile = profile_of(NULL, 0);
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        double white = ROWS[i][0], r = ROWS[i][1];
        ReviewCase c = private_case(white, r, 0.01);
        judge_case(&c, &profile, &arena);
        assert_int_equal(c.limit_count, 1);
        assert_int_equal(c.limit_id, 0);
        const LimitVerdict *limit = &c.limits[0];
        assert_string_equal(limit->kind, "visual_security");
        assert_near(limit->found, security(white, white / 100, r), 1e-12);
        assert_near(limit->low, security(white, white / 100, 0.99 * r), 1e-12);
        assert_near(limit->high, security(white, white / 100, 1.01 * r), 1e-12);
        assert_near(limit->margin, limit->found - 1, 1e-12);
        assert_near(c.margin, limit->margin, 0);
        assert_int_equal(c.verdict, i ? VERDICT_PASS : VERDICT_FAIL);
        assert_int_equal(case_kept_by(&c), i ? KEPT_SECURITY : KEPT_NOT);
        assert_false(limit->read_in_the_standard);
    }
}

/* The panel's own errors are in it, as in the contrast: less than at the worst corner of all
 * three intervals, more than by one of them. */
ARENA_TEST(its_interval_holds_the_panel_s_errors) {
    const Profile profile = profile_of(NULL, 0);
    double wide = INTERVAL_SIGMAS * 0.05;
    ReviewCase c = private_case(1, 9, 0);
    c.panel = (CasePanel){.emission_error = 0.05, .reflection_error = 0.05};
    judge_contrasts(&c, (MeanInterval){9, 9});
    judge_case(&c, &profile, &arena);
    const LimitVerdict *limit = &c.limits[0];
    assert_true(limit->low > security(1 + wide, 0.01 * (1 - wide), 9 * (1 - wide)));
    assert_true(limit->high < security(1 - wide, 0.01 * (1 + wide), 9 * (1 + wide)));
    assert_true(limit->low < security(1 + wide, 0.01, 9));
    assert_true(limit->low < security(1, 0.01, 9 * (1 - wide)));
    assert_int_equal(c.verdict, VERDICT_TOO_CLOSE);
    assert_near(limit->low, privacy_s_of_contrast(c.contrast_high), 1e-12);
    assert_near(limit->high, privacy_s_of_contrast(c.contrast_low), 1e-12);
}

/* What keeps S = 1, 2 % either side, and on it. Less of its own light passes what more of it
 * fails: the reverse of what is to be read. */
ARENA_TEST(two_per_cent_decide_what_must_not_be_read) {
    const Profile profile = profile_of(NULL, 0);
    for (int side = -1; side <= 1; side++) {
        double s = 1 + 0.02 * side, v = pow(10, s);
        double reflected = 0.99 * v - 1; /* (1 + R)/0.99 = V */
        ReviewCase c = private_case(1, reflected, 1e-3);
        judge_case(&c, &profile, &arena);
        assert_near(c.limits[0].found, s, 1e-12);
        assert_int_equal(c.verdict, side < 0   ? VERDICT_FAIL
                                    : side > 0 ? VERDICT_PASS
                                               : VERDICT_TOO_CLOSE);
        ReviewCase exact = private_case(1, reflected, 0);
        judge_case(&exact, &profile, &arena);
        if (side) assert_int_equal(exact.verdict, c.verdict);
    }
}

/* A contrast that misses a limit of reading is no proof: 2.9 : 1 misses 3 : 1 and can be
 * read. Nor do heights count. What may be read never meets a limit of security. */
ARENA_TEST(limits_of_reading_prove_nothing) {
    const ProfileLimit limits[] = {limit_of(LIMIT_CONTRAST_RATIO, 3),
                                   limit_of(LIMIT_CHARACTER_HEIGHT, 60),
                                   limit_of(LIMIT_VISUAL_SECURITY, 1.5)};
    Profile profile = profile_of(limits, 3);
    ReviewCase c = private_case(1, 0.5, 0);
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.verdict, VERDICT_FAIL);
    assert_int_equal(c.limit_count, 1);
    assert_near(c.limits[0].value, 1.5, 0);
    assert_true(c.limits[0].read_in_the_standard);
    c.must_not_be_read = false;
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.limit_count, 2);
    assert_string_equal(c.limits[0].kind, "contrast_ratio");
    assert_int_equal(c.verdict, VERDICT_FAIL);
}

/* The profile's limit of this light; else the assumed one; the review's own before both. */
ARENA_TEST(whose_limit_it_is) {
    ProfileLimit night = limit_of(LIMIT_VISUAL_SECURITY, 1.5);
    const Profile none = profile_of(NULL, 0);
    ReviewCase c = private_case(1, 20, 0); /* S = 1.33 */
    night.ambients[AMBIENT_DAY] = false;
    Profile profile = profile_of(&night, 1);
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.verdict, VERDICT_FAIL);
    c.ambient = AMBIENT_DAY;
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.verdict, VERDICT_PASS);
    assert_near(c.limits[0].value, 1, 0);
    c.ambient = AMBIENT_NIGHT;
    const Profile *own = profile_with_security(&profile, 1.2, &arena);
    judge_case(&c, own, &arena);
    assert_int_equal(c.verdict, VERDICT_PASS);
    assert_near(c.limits[0].value, 1.2, 0);
    assert_int_equal(c.limit_count, 1);
    judge_case(&c, &none, &arena);
    assert_near(c.limits[0].value, 1, 0);
}

/* Hidden altogether it passes, and says by what; of a part that is seen it is judged, however
 * small. A panel that is not usable, and light by things without data, leave it open. */
ARENA_TEST(what_is_hidden_cannot_be_read) {
    const Profile profile = profile_of(NULL, 0);
    ReviewCase c = private_case(1, 0.5, 0);
    c.visible_share = 0;
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.verdict, VERDICT_PASS);
    assert_int_equal(case_kept_by(&c), KEPT_HIDDEN);
    assert_int_equal(c.limit_count, 0);
    assert_int_equal(c.unjudged, UNJUDGED_NOT);
    assert_true(review_case_counts(&c));
    c.visible_share = 0.02;
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.verdict, VERDICT_FAIL);
    c.panel.is_unusable = true;
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.unjudged, UNJUDGED_PANEL);
    c = private_case(1, 30, 0);
    c.without_data_share = 0.2;
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.unjudged, UNJUDGED_DATA);
    c = private_case(1, 30, 0);
    c.visible_share = NAN;
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.verdict, VERDICT_UNJUDGED);
    assert_int_equal(case_kept_by(&c), KEPT_NOT);
}

/* A display that is off shows nothing: S is infinite. One in a lightless room is all there is
 * to see: S is 0. */
ARENA_TEST(no_picture_and_no_other_light) {
    const Profile profile = profile_of(NULL, 0);
    ReviewCase c = private_case(0, 0.5, 0.1);
    judge_case(&c, &profile, &arena);
    assert_true(isinf(c.limits[0].found) && c.verdict == VERDICT_PASS);
    c = private_case(1, 0, 0);
    c.luminance_cd_m2.background = 0;
    judge_contrasts(&c, (MeanInterval){0, 0});
    judge_case(&c, &profile, &arena);
    assert_near(c.limits[0].found, 0, 0);
    assert_near(c.margin, -1, 0);
    assert_int_equal(c.verdict, VERDICT_FAIL);
}

/* More paths decide it, as any other limit. */
ARENA_TEST(paths_that_decide_it) {
    const Profile profile = profile_of(NULL, 0);
    ReviewCase c = private_case(1, 0.99 * pow(10, 1.002) - 1, 0.02);
    c.paths = 1000;
    judge_case(&c, &profile, &arena);
    assert_int_equal(c.verdict, VERDICT_TOO_CLOSE);
    judge_open(&c, 0);
    assert_int_equal(c.open_by, OPEN_BY_PATHS);
    c.panel.emission_error = 0.02;
    judge_contrasts(&c, c.reflected_range);
    judge_case(&c, &profile, &arena);
    judge_open(&c, 0);
    assert_int_equal(c.open_by, OPEN_BY_PANEL);
}

ARENA_TEST(a_profile_may_limit_it_from_below_alone) {
    const Profile *profile;
    const char *path = arena_format(&arena, "%s/house.json", test_folder());
    static const char TEXT_OF[] =
        "{\"title\": \"ours\", \"edition\": \"1\", \"ambient\": {\"night_below_lx\": 5, "
        "\"twilight_below_lx\": 100, \"source\": \"x\", \"read_in_the_standard\": false}, "
        "\"limits\": [{\"ambient\": \"night\", \"kind\": \"visual_security\", \"value\": 1.2, "
        "\"unit\": \"1\", \"source\": \"house\", \"read_in_the_standard\": false%s}]}";
    write_text(path, arena_format(&arena, TEXT_OF, ", \"bound\": \"most\""));
    assert_false(profile_load(path, &arena, &profile, why()));
    assert_non_null(strstr(why()->text, "required: 'least' of visual_security"));
    write_text(path, arena_format(&arena, TEXT_OF, ""));
    assert_done(profile_load(path, &arena, &profile, &err));
    assert_int_equal(profile->limits[0].kind, LIMIT_VISUAL_SECURITY);
    assert_near(profile->security.value, SECURITY_OBSCURED, 0);
    assert_non_null(strstr(profile->security.source, "assumed"));
    assert_false(profile->is_security_own);
    remove(path);
}

TEST_PROGRAM(make_folder, remove_folder)
