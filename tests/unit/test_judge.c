/* SPDX-License-Identifier: Apache-2.0 */
/* Figures against limits. */
#include "fixture.h"

#include "base/count.h"
#include "review/judge.h"
#include "review/profile_table.h"

/* A case whose contrast ratio is `ratio`, known within a share: 100 cd/m2 of difference. */
static ReviewCase case_of(double ratio, double doubt) {
    return (ReviewCase){.ambient = AMBIENT_DAY,
                        .contrast_ratio = ratio,
                        .contrast_low = ratio * (1 - doubt),
                        .contrast_high = ratio * (1 + doubt),
                        .contrast_with_veil = ratio,
                        .luminance_cd_m2 = {.foreground = 110,
                                            .background = 10,
                                            .reflected = 100 / (ratio - 1) - 10},
                        .height_arcmin = 25,
                        .stroke_ratio = 0.15,
                        .visible_share = 1};
}

static ProfileLimit limit_of(LimitKind kind, double value) {
    return (ProfileLimit){.name = "one",
                          .kind = kind,
                          .ambients = {true, true, true, true},
                          .value = value,
                          .source = "a test"};
}

static ReviewCase judged(ReviewCase c, const ProfileLimit *limits, int count, bool uses_veil,
                         Arena *arena) {
    const Profile profile = {.limits = limits, .limit_count = count, .uses_veil = uses_veil};
    judge_case(&c, &profile, arena);
    assert_true(c.limit_count <= count);
    return c;
}

/* ---- 2 % either side --------------------------------------------------------------------- */

typedef struct Row {
    LimitKind kind;
    bool is_upper;
    double limit, ratio, height; /* what gives the limit exactly */
} Row;

static const Row ROWS[] = {
    {LIMIT_CONTRAST_RATIO, false, 5, 5, 25},     {LIMIT_CONTRAST_RATIO, false, 3, 3, 25},
    {LIMIT_CONTRAST_RATIO, false, 2, 2, 25},     {LIMIT_CONTRAST_RATIO, true, 40, 40, 25},
    {LIMIT_LUMINANCE_CONTRAST, false, 2, 3, 25}, {LIMIT_LUMINANCE_CONTRAST, false, 4.66, 5.66, 25},
    {LIMIT_MODULATION, false, 0.5, 3, 25},       {LIMIT_MODULATION, true, 0.6, 4, 25},
    {LIMIT_CHARACTER_HEIGHT, false, 12, 5, 12},  {LIMIT_CHARACTER_HEIGHT, true, 60, 5, 60},
};

ARENA_TEST(two_per_cent_decide) {
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        for (int side = -1; side <= 1; side += 2) {
            const Row *r = &ROWS[i];
            ProfileLimit limit = limit_of(r->kind, r->limit);
            bool is_contrast = quantity_is_contrast(r->kind);
            ReviewCase c = case_of(r->ratio * (is_contrast ? 1 + 0.02 * side : 1), 0.001);
            limit.is_upper = r->is_upper;
            c.height_arcmin = r->height * (is_contrast ? 1 : 1 + 0.02 * side);
            c = judged(c, &limit, 1, false, &arena);
            bool passes = (side > 0) != r->is_upper;
            if (c.verdict != (passes ? VERDICT_PASS : VERDICT_FAIL))
                fail_msg("%s of %g, side %d: %s", limit_kind_names[r->kind], r->limit, side,
                         verdict_names[c.verdict]);
            assert_int_equal(c.limits[0].verdict, c.verdict);
            assert_true((c.limits[0].margin > 0) == passes);
            assert_int_equal(c.limit_id, is_contrast && !r->is_upper ? 0 : -1);
        }
    }
}

ARENA_TEST(margins_are_what_they_say) {
    ProfileLimit least = limit_of(LIMIT_CONTRAST_RATIO, 3), most = least;
    ReviewCase c = judged(case_of(3.6, 0), &least, 1, false, &arena);
    assert_close(c.margin, log(3.6) / log(3) - 1, 1e-12);
    assert_close(c.limits[0].margin, c.margin, 0);
    assert_near(c.limits[0].found, 3.6, 0);
    assert_near(c.limits[0].value, 3, 0);
    assert_string_equal(c.limits[0].kind, "contrast_ratio");
    assert_string_equal(c.limits[0].unit, "1");
    assert_string_equal(c.limits[0].source, "a test");
    most.is_upper = true;
    c = judged(case_of(2.4, 0), &most, 1, false, &arena);
    assert_true(c.limits[0].is_upper);
    assert_close(c.limits[0].margin, log(3) / log(2.4) - 1, 1e-12);
    assert_true(isnan(c.margin));
}

/* Full wash-out is -1 under every limit, a limit that is just kept 0; what two limits require
 * in other words has one margin. 1.014 under 3 lies behind 1.347 under 2. */
TEST(wash_out_is_the_same_for_every_limit) {
    static const LimitKind KINDS[] = {LIMIT_CONTRAST_RATIO, LIMIT_LUMINANCE_CONTRAST,
                                      LIMIT_MODULATION};
    static const double ASKED[] = {1.05, 1.5, 2, 3, 10, 1000}, FOUND[] = {1.014, 1.347, 2, 7};
    for (int k = 0; k < COUNT_OF(KINDS); k++) {
        for (int i = 0; i < COUNT_OF(ASKED); i++) {
            double limit = contrast_from_ratio(KINDS[k], ASKED[i]);
            assert_close(ratio_from_contrast(KINDS[k], limit), ASKED[i], 1e-12);
            assert_near(quantity_margin(KINDS[k], false, contrast_from_ratio(KINDS[k], 1), limit),
                        -1, 0);
            assert_near(quantity_margin(KINDS[k], false, limit, limit), 0, 0);
            for (int f = 0; f < COUNT_OF(FOUND); f++) {
                double found = contrast_from_ratio(KINDS[k], FOUND[f]);
                double margin = quantity_margin(KINDS[k], false, found, limit);
                double upper = quantity_margin(KINDS[k], true, found, limit);
                assert_near(margin, log(FOUND[f]) / log(ASKED[i]) - 1, 1e-9);
                assert_near((1 + margin) * (1 + upper), 1, 1e-9);
            }
        }
        double most = contrast_from_ratio(KINDS[k], INFINITY);
        assert_true(isinf(quantity_margin(KINDS[k], false, most, 0.5)));
    }
    assert_near(quantity_margin(LIMIT_CHARACTER_HEIGHT, false, 0, 12), -1, 0);
    assert_near(quantity_margin(LIMIT_CHARACTER_HEIGHT, false, 18, 12), 0.5, 1e-12);
    assert_true(quantity_margin(LIMIT_CONTRAST_RATIO, false, 1.014, 3) <
                quantity_margin(LIMIT_CONTRAST_RATIO, false, 1.347, 2));
    assert_near(quantity_margin(LIMIT_CONTRAST_RATIO, false, 1, 1), 0, 0);
    assert_true(isinf(quantity_margin(LIMIT_CONTRAST_RATIO, false, 2, 1)));
    assert_near(quantity_margin(LIMIT_MODULATION, false, 0.9, 1), -1, 0);
    assert_true(isnan(quantity_margin(LIMIT_CONTRAST_RATIO, false, NAN, 2)));
}

ARENA_TEST(what_lies_on_the_limit_keeps_it) {
    ProfileLimit limits[] = {limit_of(LIMIT_CONTRAST_RATIO, 3), limit_of(LIMIT_CONTRAST_RATIO, 3)};
    limits[1].is_upper = true;
    ReviewCase c = judged(case_of(3, 0), limits, 2, false, &arena);
    assert_int_equal(c.verdict, VERDICT_PASS);
}

/* ---- doubt ------------------------------------------------------------------------------- */

ARENA_TEST(an_interval_across_the_limit_is_too_close) {
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        for (int side = -1; side <= 1; side += 2) {
            ProfileLimit limit = limit_of(ROWS[i].kind, ROWS[i].limit);
            limit.is_upper = ROWS[i].is_upper;
            if (!quantity_is_contrast(limit.kind)) continue;
            ReviewCase c = case_of(ROWS[i].ratio * (1 + 0.02 * side), 0.03);
            c = judged(c, &limit, 1, false, &arena);
            assert_int_equal(c.verdict, VERDICT_TOO_CLOSE);
            assert_true(c.limits[0].low < limit.value && c.limits[0].high > limit.value);
            assert_true(isfinite(c.limits[0].margin));
        }
    }
}

static void assert_unjudged(ReviewCase c, Unjudged why) {
    assert_int_equal(c.verdict, VERDICT_UNJUDGED);
    assert_int_equal(c.unjudged, why);
    assert_true(unjudged_names[why] != NULL);
}

ARENA_TEST(what_is_not_known_cannot_be_judged) {
    ProfileLimit contrast = limit_of(LIMIT_CONTRAST_RATIO, 3);
    ProfileLimit height = limit_of(LIMIT_CHARACTER_HEIGHT, 12);
    ReviewCase c = case_of(NAN, 0);
    assert_unjudged(judged(c, &contrast, 1, false, &arena), UNJUDGED_FIGURE);
    c = case_of(5, 0);
    c.contrast_low = NAN;
    assert_unjudged(judged(c, &contrast, 1, false, &arena), UNJUDGED_FIGURE);
    c = case_of(5, 0);
    c.height_arcmin = NAN;
    assert_unjudged(judged(c, &height, 1, false, &arena), UNJUDGED_FIGURE);
    contrast.is_upper = true;
    c = case_of(NAN, 0);
    assert_unjudged(judged(c, &contrast, 1, false, &arena), UNJUDGED_FIGURE);
}

/* A panel that is not usable makes everything so, light via things without data the contrast
 * alone: a height that fails fails. */
ARENA_TEST(panels_and_data_decide_what_can_be_judged) {
    ProfileLimit limits[] = {limit_of(LIMIT_CONTRAST_RATIO, 3),
                             limit_of(LIMIT_CHARACTER_HEIGHT, 12)};
    ReviewCase c = case_of(5, 0);
    c.panel.is_unusable = true;
    assert_unjudged(judged(c, limits, 2, false, &arena), UNJUDGED_PANEL);
    c = case_of(1.1, 0);
    c.panel.is_unusable = true;
    c.height_arcmin = 5;
    assert_unjudged(judged(c, limits, 2, false, &arena), UNJUDGED_PANEL);
    c = case_of(5, 0);
    c.without_data_share = UNJUDGED_DATA_SHARE;
    assert_int_equal(judged(c, limits, 2, false, &arena).verdict, VERDICT_PASS);
    c.without_data_share = UNJUDGED_DATA_SHARE + 1e-6;
    assert_unjudged(judged(c, limits, 2, false, &arena), UNJUDGED_DATA);
    assert_int_equal(judged(c, limits + 1, 1, false, &arena).verdict, VERDICT_PASS);
    c.height_arcmin = 5;
    c = judged(c, limits, 2, false, &arena);
    assert_int_equal(c.verdict, VERDICT_FAIL);
    assert_int_equal(c.unjudged, UNJUDGED_NOT);
}

/* What an eye need not see, and what has no limit, does not count. */
ARENA_TEST(what_is_not_asked_does_not_count) {
    ProfileLimit limit = limit_of(LIMIT_CONTRAST_RATIO, 3);
    ReviewCase c = case_of(5, 0);
    assert_unjudged(judged(c, NULL, 0, false, &arena), UNJUDGED_LIMIT);
    c = judged(c, NULL, 0, false, &arena);
    assert_false(review_case_counts(&c));
    c = case_of(5, 0);
    c.visible_share = 0;
    c = judged(c, &limit, 1, false, &arena);
    assert_true(review_case_counts(&c));
    c.is_optional = true;
    assert_false(review_case_counts(&c));
    c.visible_share = 1;
    c = judged(c, &limit, 1, false, &arena);
    assert_true(review_case_counts(&c));
    c.without_data_share = 1;
    c = judged(c, &limit, 1, false, &arena);
    assert_true(review_case_counts(&c));
    c = review_case_unknown();
    assert_true(review_case_counts(&c) && isnan(c.contrast_ratio) && isnan(c.stroke_ratio));
}

/* Of what is reflected alone: 110 and 10 cd/m2 with 40 of it give 3. A panel whose reflection
 * is known within a standard error of 10 % gives the ends of 40 (1 +- 0.196); with errors of
 * the two luminances, and of sampling, the halves add up as squares. */
ARENA_TEST(the_panel_s_own_error_is_in_the_interval) {
    double sigmas = INTERVAL_SIGMAS;
    ReviewCase c = {
        .luminance_cd_m2 = {.foreground = 110, .background = 10, .reflected = 40, .veil = NAN},
        .panel = {.reflection_error = 0.1}};
    judge_contrasts(&c, (MeanInterval){40, 40});
    assert_close(c.contrast_low, 1 + 100 / (10 + 40 * (1 + 0.1 * sigmas)), 1e-9);
    assert_close(c.contrast_high, 1 + 100 / (10 + 40 * (1 - 0.1 * sigmas)), 1e-9);
    double by_reflection = 3 - c.contrast_low;
    c.panel = (CasePanel){.emission_error = 0.02};
    judge_contrasts(&c, (MeanInterval){40, 40});
    double by_bright = 110 * 0.02 * sigmas / 50, dark = 10 * (1 + 0.02 * sigmas) + 40;
    assert_close(c.contrast_low, 3 - hypot(by_bright, 3 - 150 / dark), 1e-9);
    double by_emission = 3 - c.contrast_low;
    c.panel = (CasePanel){.reflection_error = 0.1, .emission_error = 0.02};
    judge_contrasts(&c, (MeanInterval){38, 43});
    double by_sampling = 3 - 153.0 / 53;
    assert_close(3 - c.contrast_low, hypot(by_sampling, hypot(by_reflection, by_emission)), 1e-9);
    c.panel = (CasePanel){0};
    judge_contrasts(&c, (MeanInterval){38, 43});
    assert_close(c.contrast_low, 153.0 / 53, 1e-12);
    assert_close(c.contrast_high, 148.0 / 48, 1e-12);
    c.panel = (CasePanel){.reflection_error = 50, .emission_error = 50};
    judge_contrasts(&c, (MeanInterval){38, 43});
    assert_near(c.contrast_low, 1, 0);
}

/* Sampling gives 2 % of doubt, the panel as much: paths lessen the first alone. */
ARENA_TEST(no_path_lessens_the_panel_s_error) {
    ProfileLimit limit = limit_of(LIMIT_CONTRAST_RATIO, 2.9);
    ReviewCase c = {.ambient = AMBIENT_DAY,
                    .visible_share = 1,
                    .height_arcmin = 25,
                    .luminance_cd_m2 = {110, 10, 40, 0, 40, NAN},
                    .paths = 1000,
                    .panel = {.reflection_error = 0.1}};
    judge_contrasts(&c, (MeanInterval){38, 43});
    c = judged(c, &limit, 1, false, &arena);
    assert_int_equal(c.verdict, VERDICT_TOO_CLOSE);
    judge_open(&c, 0);
    assert_int_equal(c.open_by, OPEN_BY_PANEL);
    c.panel = (CasePanel){0};
    judge_contrasts(&c, (MeanInterval){38, 43});
    c = judged(c, &limit, 1, false, &arena);
    judge_open(&c, 0);
    assert_int_equal(c.open_by, OPEN_BY_PATHS);
}

ARENA_TEST(nothing_visible_is_no_verdict_on_legibility) {
    ProfileLimit limit = limit_of(LIMIT_CONTRAST_RATIO, 3);
    ReviewCase c = case_of(9, 0);
    c.visible_share = 0;
    c = judged(c, &limit, 1, false, &arena);
    assert_int_equal(c.verdict, VERDICT_UNJUDGED);
    assert_int_equal(c.limits[0].verdict, VERDICT_UNJUDGED);
    assert_true(isnan(c.limits[0].found));
    c.visible_share = 0;
    assert_int_equal(judged(c, NULL, 0, false, &arena).verdict, VERDICT_UNJUDGED);
    c = case_of(9, 0);
    c.visible_share = 0.5; /* of 38 a 3 is left */
    assert_unjudged(judged(c, &limit, 1, false, &arena), UNJUDGED_HIDDEN);
    c.visible_share = 0.51;
    assert_int_equal(judged(c, &limit, 1, false, &arena).verdict, VERDICT_PASS);
}

/* ---- which limits ------------------------------------------------------------------------ */

ARENA_TEST(the_worst_that_counts_decides) {
    ProfileLimit limits[] = {limit_of(LIMIT_CONTRAST_RATIO, 2), limit_of(LIMIT_CONTRAST_RATIO, 6),
                             limit_of(LIMIT_CHARACTER_HEIGHT, 30)};
    limits[1].is_advice = true;
    limits[2].is_advice = true;
    ReviewCase c = judged(case_of(4, 0.01), limits, 3, false, &arena);
    assert_int_equal(c.verdict, VERDICT_PASS);
    assert_int_equal(c.limits[1].verdict, VERDICT_FAIL);
    assert_true(c.limits[1].is_advice && !c.limits[0].is_advice);
    assert_int_equal(c.limit_id, 0);
    limits[2].is_advice = false;
    c = judged(case_of(4, 0.01), limits, 3, false, &arena);
    assert_int_equal(c.verdict, VERDICT_FAIL);
    c = judged(case_of(2, 0.01), limits, 2, false, &arena);
    assert_int_equal(c.verdict, VERDICT_TOO_CLOSE);
    c = judged(case_of(2, 0.01), limits, 3, false, &arena);
    assert_int_equal(c.verdict, VERDICT_FAIL);
}

/* 0.7 of modulation is a ratio of 5.67, a luminance contrast of 5 one of 6. */
ARENA_TEST(the_contrast_that_is_asked_most_of_is_the_limit) {
    ProfileLimit limits[] = {
        limit_of(LIMIT_CHARACTER_HEIGHT, 12), limit_of(LIMIT_CONTRAST_RATIO, 5),
        limit_of(LIMIT_LUMINANCE_CONTRAST, 5), limit_of(LIMIT_MODULATION, 0.7)};
    ReviewCase c = judged(case_of(7, 0), limits, 4, false, &arena);
    assert_int_equal(c.limit_id, 2);
    assert_close(c.margin, log(7) / log(6) - 1, 1e-12);
    limits[2].ambients[AMBIENT_DAY] = false;
    c = judged(case_of(7, 0), limits, 4, false, &arena);
    assert_int_equal(c.limit_count, 3);
    assert_string_equal(c.limits[c.limit_id].kind, "modulation");
    limits[3].value = 1; /* no ratio is enough */
    c = judged(case_of(1e9, 0), limits, 4, false, &arena);
    assert_int_equal(c.verdict, VERDICT_FAIL);
    assert_string_equal(c.limits[c.limit_id].kind, "modulation");
}

ARENA_TEST(limits_belong_to_their_light) {
    const Profile *profile;
    assert_done(profile_load("iso-15008", &arena, &profile, &err));
    for (int a = 0; a < AMBIENT_COUNT; a++) {
        const Verdict expected[] = {VERDICT_FAIL, VERDICT_FAIL, VERDICT_PASS, VERDICT_PASS};
        ReviewCase c = case_of(4, 0.01);
        c.ambient = (Ambient)a;
        judge_case(&c, profile, &arena);
        assert_int_equal(c.verdict, expected[a]);
        assert_int_equal(c.limit_count, 8);
    }
}

/* NUREG-0700: the smaller the characters, the more modulation, from 17 down to 10 minutes. */
ARENA_TEST(small_characters_need_more) {
    static const double HEIGHTS[] = {10, 12, 15, 17}, VALUES[] = {1, 0.86, 0.65, 0.51};
    const Profile *profile;
    assert_done(profile_load("nureg-0700", &arena, &profile, &err));
    for (int i = 0; i < COUNT_OF(HEIGHTS); i++) {
        ReviewCase c = case_of(8, 0);
        c.height_arcmin = HEIGHTS[i];
        judge_case(&c, profile, &arena);
        assert_int_equal(c.limit_count, 3);
        assert_close(c.limits[2].value, VALUES[i], 1e-12);
        assert_close(c.limits[2].found, 7.0 / 9, 1e-12);
        assert_int_equal(c.verdict, VALUES[i] > 7.0 / 9 ? VERDICT_FAIL : VERDICT_PASS);
        c.height_arcmin = 17.01;
        judge_case(&c, profile, &arena);
        assert_int_equal(c.limit_count, 2);
        assert_int_equal(c.verdict, VERDICT_PASS);
    }
}

/* Where a shape has strokes their ratio is held against its limit; a width is not measured. */
ARENA_TEST(strokes_count_where_there_are_some) {
    ProfileLimit limits[] = {limit_of(LIMIT_STROKE_RATIO, 0.1), limit_of(LIMIT_WIDTH_RATIO, 0.65)};
    ReviewCase c = case_of(4, 0);
    c.stroke_ratio = NAN;
    c = judged(c, limits, 2, false, &arena);
    assert_int_equal(c.limit_count, 2);
    assert_unjudged(c, UNJUDGED_LIMIT);
    assert_true(isnan(c.limits[0].found) && isnan(c.limits[1].margin));
    c.stroke_ratio = 0.12;
    c = judged(c, limits, 2, false, &arena);
    assert_int_equal(c.verdict, VERDICT_PASS);
    assert_close(c.limits[0].margin, 0.2, 1e-12);
    limits[0].value = 0.13;
    assert_int_equal(judged(c, limits, 2, false, &arena).verdict, VERDICT_FAIL);
}

ARENA_TEST(without_limits_nothing_can_be_judged) {
    for (int i = 0; i < profile_count; i++) {
        const Profile *profile;
        assert_done(profile_load(profile_table[i].name, &arena, &profile, &err));
        ReviewCase c = case_of(1.01, 0);
        c.ambient = AMBIENT_SUN;
        judge_case(&c, profile, &arena);
        assert_int_equal(c.verdict, profile->limit_count ? VERDICT_FAIL : VERDICT_UNJUDGED);
        assert_int_equal(c.limit_id >= 0, profile->limit_count > 0);
        assert_int_equal(isnan(c.margin), profile->limit_count == 0);
    }
}

/* ---- the veil ---------------------------------------------------------------------------- */

/* 110 and 10 cd/m2 with 40 reflected: 3; below a veil of 50: 2. */
ARENA_TEST(a_veil_counts_where_the_profile_says_so) {
    ProfileLimit limit = limit_of(LIMIT_CONTRAST_RATIO, 2.5);
    ReviewCase c = case_of(3, 0.02);
    assert_close(c.luminance_cd_m2.reflected, 40, 1e-12);
    c.luminance_cd_m2.veil = 50;
    c.contrast_with_veil = (110.0 + 40 + 50) / (10 + 40 + 50);
    assert_int_equal(judged(c, &limit, 1, false, &arena).verdict, VERDICT_PASS);
    ReviewCase veiled = judged(c, &limit, 1, true, &arena);
    assert_int_equal(veiled.verdict, VERDICT_FAIL);
    assert_near(veiled.limits[0].found, 2, 1e-12);
    /* Its ends are those reflections, with the veil. */
    for (int side = -1; side <= 1; side += 2) {
        double ratio = 3 * (1 + 0.02 * side), reflected = 100 / (ratio - 1) - 10;
        double end = side < 0 ? veiled.limits[0].low : veiled.limits[0].high;
        assert_close(end, (110 + reflected + 50) / (10 + reflected + 50), 1e-12);
    }
    limit.value = 2;
    assert_int_equal(judged(c, &limit, 1, true, &arena).verdict, VERDICT_TOO_CLOSE);
    c.luminance_cd_m2.veil = 0;
    c.contrast_with_veil = 3;
    veiled = judged(c, &limit, 1, true, &arena);
    assert_close(veiled.limits[0].low, c.contrast_low, 1e-12);
    assert_close(veiled.limits[0].high, c.contrast_high, 1e-12);
}

/* ---- the ambient ------------------------------------------------------------------------- */

ARENA_TEST(the_ambient_comes_from_the_display_s_light) {
    const Profile *profile;
    ReviewCase c = case_of(4, 0);
    assert_done(profile_load("iso-15008", &arena, &profile, &err));
    c.display_lux = 0.2;
    judge_ambient(&c, profile, false);
    assert_int_equal(c.ambient, AMBIENT_NIGHT);
    c.display_lux = 3000;
    judge_ambient(&c, profile, false);
    assert_int_equal(c.ambient, AMBIENT_DAY);
    judge_ambient(&c, profile, true);
    assert_int_equal(c.ambient, AMBIENT_SUN);
}

TEST_PROGRAM(make_arena, drop_arena)
