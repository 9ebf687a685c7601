/* SPDX-License-Identifier: Apache-2.0 */
/* Visibility levels of a case, and limits on them. */
#include "fixture.h"

#include <string.h>

#include "base/count.h"
#include "review/judge.h"
#include "vision/visibility.h"

static ProfileLimit level_limit(double value) {
    return (ProfileLimit){.name = "one",
                          .kind = LIMIT_VISIBILITY_LEVEL,
                          .value = value,
                          .ambients = {true, true, true, true},
                          .source = "a test"};
}

static ReviewCase judged(ReviewCase c, const ProfileLimit *limit, Arena *arena) {
    const Profile profile = {.limits = limit, .limit_count = limit ? 1 : 0};
    judge_case(&c, &profile, arena);
    return c;
}

/* 30 on 2 cd/m2, of which 1 is reflected, beside a veil of 0.5 in the observer's eye. */
static ReviewCase seen_by(const CaseVisibility *levels, int count) {
    return (ReviewCase){
        .ambient = AMBIENT_NIGHT,
        .visible_share = 1,
        .height_arcmin = 25,
        .stroke_ratio = 0.15,
        .glasses_transmittance = 1,
        .contrast_ratio = 15.5,
        .contrast_low = 15,
        .contrast_high = 16,
        .contrast_with_veil = 12.6,
        .luminance_cd_m2 = {.foreground = 30, .background = 1, .reflected = 1, .veil = 0.5},
        .reflected_range = {0.9, 1.1},
        .visibilities = levels,
        .visibility_count = count};
}

static const CaseVisibility TWO_AGES[] = {
    {.age_years = 30, .is_observer = true, .size_arcmin = 3, .glance_s = 0.2, .veil_times = 1},
    {.age_years = 70, .size_arcmin = 3, .glance_s = 0.2, .veil_times = 1.4}};

static double level_by_hand(double reflected, double veil, double age) {
    VisibilityTarget t = {3, 1 + reflected + veil, age, 0.2, false};
    return visibility_level(&t, 29);
}

ARENA_TEST(levels_follow_the_luminances) {
    ReviewCase c = judged(seen_by(TWO_AGES, 2), NULL, &arena);
    const CaseVisibility *v = c.visibilities;
    assert_close(v[0].level, level_by_hand(1, 0.5, 30), 1e-14);
    assert_close(v[0].low, level_by_hand(1.1, 0.5, 30), 1e-14);
    assert_close(v[0].high, level_by_hand(0.9, 0.5, 30), 1e-14);
    assert_close(v[1].level, level_by_hand(1, 0.7, 70), 1e-14);
    assert_close(v[0].adapted_cd_m2, 2.5, 1e-14);
    assert_close(v[1].adapted_cd_m2, 2.7, 1e-14);
    assert_close(v[0].threshold_cd_m2 * v[0].level, 29, 1e-14);
    assert_true(v[0].low < v[0].level && v[0].level < v[0].high);
    assert_null(v[0].doubts);
}

/* Dark on light: darker than its background, and a lower threshold by the polarity's factor. */
ARENA_TEST(levels_know_the_polarity) {
    ReviewCase c = seen_by(TWO_AGES, 1);
    c.luminance_cd_m2.foreground = 1;
    c.luminance_cd_m2.background = 30;
    VisibilityTarget t = {3, 30 + 1 + 0.5, 30, 0.2, true};
    c = judged(c, NULL, &arena);
    assert_close(c.visibilities[0].level, visibility_level(&t, 29), 1e-14);
}

/* Behind lenses of 20 % the eye is adapted to less, and sees less of a difference. */
ARENA_TEST(levels_are_those_behind_glasses) {
    ReviewCase c = seen_by(TWO_AGES, 1);
    c.glasses_transmittance = 0.2;
    VisibilityTarget t = {3, 0.2 * 2.5, 30, 0.2, false};
    c = judged(c, NULL, &arena);
    assert_close(c.visibilities[0].level, visibility_level(&t, 0.2 * 29), 1e-14);
}

/* The panel's errors are in the ends: each by itself, as squares. */
ARENA_TEST(levels_hold_the_panels_errors) {
    ReviewCase c = seen_by(TWO_AGES, 1);
    c.panel.emission_error = 0.05;
    c.panel.reflection_error = 0.1;
    c = judged(c, NULL, &arena);
    double level = level_by_hand(1, 0.5, 30), e = 1.959964;
    VisibilityTarget dimmer = {3, 1 + e * 0.05 + 1.5, 30, 0.2, false};
    double away[] = {level_by_hand(1.1, 0.5, 30) - level,
                     level_by_hand(1 + e * 0.1, 0.5, 30) - level,
                     level * (29 - e * 0.05 * 30) / 29 - level,
                     visibility_level(&dimmer, 29 - e * 0.05) - level};
    double squares = 0;
    for (int i = 0; i < COUNT_OF(away); i++) squares += away[i] * away[i];
    assert_close(c.visibilities[0].level, level, 1e-14);
    assert_close(c.visibilities[0].low, level - sqrt(squares), 1e-12);
}

/* A limit is about the least level of all ages, an upper one about the greatest. */
ARENA_TEST(a_limit_of_visibility_is_about_the_least) {
    double young = level_by_hand(1, 0.5, 30), old = level_by_hand(1, 0.7, 70);
    assert_true(old < young);
    for (int side = -1; side <= 1; side++) {
        ProfileLimit limit = level_limit(old * (1 + 0.2 * side));
        ReviewCase c = judged(seen_by(TWO_AGES, 2), &limit, &arena);
        const LimitVerdict *l = &c.limits[0];
        Verdict wants = side < 0 ? VERDICT_PASS : side ? VERDICT_FAIL : VERDICT_TOO_CLOSE;
        assert_int_equal(c.verdict, wants);
        assert_int_equal(l->verdict, wants);
        assert_close(l->found, old, 1e-12);
        assert_true(l->low == c.visibilities[1].low && l->high == c.visibilities[1].high);
        assert_near(l->margin, old / limit.value - 1, 1e-12);
        assert_true(l->age_years == 70);
        assert_int_equal(c.limit_id, -1);
        assert_string_equal(l->kind, "visibility_level");
    }
    ProfileLimit most = level_limit(0.5 * (young + old));
    most.is_upper = true;
    ReviewCase c = judged(seen_by(TWO_AGES, 2), &most, &arena);
    assert_int_equal(c.verdict, VERDICT_FAIL);
    assert_true(c.limits[0].age_years == 30);
}

/* Too much light by things without data leaves a level as open as a contrast; an age that is
 * not published leaves none. */
ARENA_TEST(a_level_that_is_not_known_is_not_judged) {
    ProfileLimit limit = level_limit(1);
    ReviewCase c = seen_by(TWO_AGES, 2);
    c.without_data_share = 0.2;
    c = judged(c, &limit, &arena);
    assert_int_equal(c.unjudged, UNJUDGED_DATA);
    CaseVisibility ages[] = {TWO_AGES[0], TWO_AGES[1]};
    ages[1].age_years = 80;
    c = judged(seen_by(ages, 2), &limit, &arena);
    assert_int_equal(c.verdict, VERDICT_UNJUDGED);
    assert_int_equal(c.unjudged, UNJUDGED_FIGURE);
    assert_true(isnan(c.limits[0].found) && c.limits[0].age_years == 80);
    assert_non_null(strstr(c.visibilities[1].doubts, "80 years"));
    c = judged(seen_by(NULL, 0), &limit, &arena);
    assert_int_equal(c.unjudged, UNJUDGED_FIGURE);
}

/* What is known of the veil is an end of its own; where that reaches the limit, no path to the
 * symbol decides. */
ARENA_TEST(a_level_is_as_sure_as_the_veil) {
    CaseVisibility in_doubt = TWO_AGES[0];
    in_doubt.veil_doubt = 0.4;
    double level = level_by_hand(1, 0.5, 30), sampled = level_by_hand(1.1, 0.5, 30) - level;
    double veiled = level_by_hand(1, 0.7, 30) - level;
    ProfileLimit limit = level_limit(level * 1.001);
    ReviewCase c = seen_by(&in_doubt, 1);
    c.paths = 8192;
    c = judged(c, &limit, &arena);
    double both = sqrt(sampled * sampled + veiled * veiled);
    assert_close(c.visibilities[0].low, level - both, 1e-12);
    assert_int_equal(c.verdict, VERDICT_TOO_CLOSE);
    judge_open(&c, 0);
    assert_int_equal(c.open_by, OPEN_BY_VEIL);
    assert_true(case_is_undecidable(&c));
}

/* Errors of sampling alone keep it open. */
ARENA_TEST(paths_decide_a_level) {
    double old = level_by_hand(1, 0.7, 70);
    for (int i = 0; i < 3; i++) {
        ProfileLimit limit = level_limit(old * (1 + 0.004 * (i + 1)));
        ReviewCase c = seen_by(TWO_AGES, 2);
        c.paths = 8192;
        c = judged(c, &limit, &arena);
        assert_int_equal(c.verdict, VERDICT_TOO_CLOSE);
        judge_open(&c, 0);
        assert_int_equal(c.open_by, OPEN_BY_PATHS);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
