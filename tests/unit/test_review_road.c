/* SPDX-License-Identifier: Apache-2.0 */
/* Gazes at roads: limits, what counts, and what is written of them. */
#include "review/export/review_junit.h"
#include "review/judge.h"
#include "review/output/review_diff.h"
#include "review/output/review_json.h"
#include "review/finding.h"
#include "review/output/review_page.h"
#include "review/output/review_road.h"
#include "review/output/review_todo.h"
#include "review_page_fixture.h"
#include "road_fixture.h"

static const Profile profile = {.increment_most_pct = 15};

/* A gaze at that road, whose names are those of the fixture's third. */
static GazeFinding judged(double old_pct, double half, double unusable, double without_data) {
    Review review = fixture_review(&arena);
    GazeFinding gaze = review.gazes[2];
    gaze.road = fixture_road(&arena, old_pct, half);
    gaze.road->without_data_share = without_data;
    gaze.road->unusable_share = unusable;
    judge_gaze(&gaze, &profile, &arena);
    return gaze;
}

/* ---- verdicts ---------------------------------------------------------------------------- */

TEST(an_increment_is_judged_by_its_whole_interval) {
    static const struct {
        double pct, half;
        Verdict verdict;
    } rows[] = {{14, 0.9, VERDICT_PASS},
                {14, 1.1, VERDICT_TOO_CLOSE},
                {15.5, 1, VERDICT_TOO_CLOSE},
                {16.1, 1, VERDICT_FAIL},
                {15, 0, VERDICT_PASS}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        GazeFinding gaze = judged(rows[i].pct, rows[i].half, 0, 0);
        const GazeRoad *road = gaze.road;
        assert_true(road_has_limit(road));
        assert_int_equal(gaze.limit_count, 2);
        assert_int_equal(gaze.verdict, rows[i].verdict);
        assert_int_equal(gaze.unjudged, UNJUDGED_NOT);
        assert_int_equal(road->ages[0].limit.verdict, VERDICT_PASS);
        assert_close(road->ages[1].limit.margin + 1, 15 / rows[i].pct, 1e-12);
        assert_true(road->ages[1].limit.found == rows[i].pct);
        assert_true(road->ages[1].limit.low == rows[i].pct - rows[i].half);
    }
}

/* Of two limits the road's ages have the worse, advice apart; judged anew they have the new one. */
TEST(of_several_limits_of_an_increment_the_worst_decides) {
    ProfileLimit limits[3];
    Profile both = {.limits = limits, .limit_count = 3, .increment_most_pct = 15};
    for (int i = 0; i < 3; i++)
        limits[i] = (ProfileLimit){.name = i == 1 ? "strict" : "loose",
                                   .kind = LIMIT_THRESHOLD_INCREMENT,
                                   .ambients = {true, true, true, true},
                                   .is_upper = true,
                                   .is_advice = i == 2,
                                   .value = i == 1   ? 15
                                            : i == 2 ? 1
                                                     : 50};
    GazeFinding gaze = judged(30, 1, 0, 0);
    judge_gaze(&gaze, &both, &arena);
    assert_int_equal(gaze.limit_count, 6);
    assert_int_equal(gaze.verdict, VERDICT_FAIL);
    assert_string_equal(gaze_worst_age(&gaze)->limit.name, "strict");
    both.limit_count = 1;
    judge_gaze(&gaze, &both, &arena);
    assert_int_equal(gaze.verdict, VERDICT_PASS);
    assert_string_equal(gaze_worst_age(&gaze)->limit.name, "loose");
}

TEST(what_nobody_measured_is_not_judged) {
    assert_int_equal(judged(2, 0.1, 0, 0.11).verdict, VERDICT_UNJUDGED);
    assert_int_equal(judged(2, 0.1, 0, 0.11).unjudged, UNJUDGED_DATA);
    assert_int_equal(judged(2, 0.1, 0.11, 0).unjudged, UNJUDGED_PANEL);
    assert_int_equal(judged(2, 0.1, 0.09, 0.09).verdict, VERDICT_PASS);
    assert_int_equal(judged((double)NAN, 0.1, 0, 0).unjudged, UNJUDGED_FIGURE);
}

TEST(without_a_limit_nothing_counts) {
    const Profile none = {.increment_most_pct = NAN};
    GazeFinding gaze = {.road = fixture_road(&arena, 40, 1)};
    judge_gaze(&gaze, &none, &arena);
    assert_int_equal(gaze.limit_count, 0);
    assert_null(gaze_worst_age(&gaze));
    gaze.road = fixture_road(&arena, 40, 1);
    gaze.road->left_out = ROAD_BY_DAY;
    judge_gaze(&gaze, &profile, &arena);
    assert_int_equal(gaze.limit_count, 0);
    gaze.road = NULL;
    judge_gaze(&gaze, &profile, &arena);
    assert_int_equal(gaze.limit_count, 0);
}

/* The fixture's review, in which the third gaze is at a road by night. */
static Review review_with(GazeFinding gaze) {
    Review review = fixture_review(&arena);
    review.gazes[2] = gaze;
    return review;
}

TEST(a_gaze_counts_as_a_case_does) {
    Review before = fixture_review(&arena);
    ReviewCounts counts = review_count(&before);
    Review review = review_with(judged(30, 1, 0, 0));
    ReviewCounts more = review_count(&review);
    assert_int_equal(more.total, counts.total + 1);
    assert_int_equal(more.of[VERDICT_FAIL], counts.of[VERDICT_FAIL] + 1);
    Findings all = review_findings(&review, &arena);
    assert_ptr_equal(all.list[all.count - 1].gaze, &review.gazes[2]);
    review.case_count = review.sweep_count = review.without_data_count = 0;
    assert_false(review_decide(&review));
    assert_int_equal(review_verdict(&review), VERDICT_FAIL);
    review.gazes[2] = judged(2, 1, 0, 0);
    assert_true(review_decide(&review));
    review.gazes[2] = judged(2, 1, 0, 1);
    assert_false(review_decide(&review));
    assert_int_equal(review_verdict(&review), VERDICT_UNJUDGED);
    review.gazes[2] = judged(15, 1, 0, 0);
    assert_true(review_decide(&review));
    review.is_strict = true;
    assert_false(review_decide(&review));
}

/* ---- what is written --------------------------------------------------------------------- */

TEST(a_road_is_read_as_it_was_written) {
    GazeFinding gaze = judged(30, 1, 0, 0.05);
    GazeRoad *road = gaze.road;
    Review again, review = review_with(gaze);
    const char *path = fresh_name(".json");
    fixture_dimming(road);
    assert_done(review_json_write(review_json(&review), path, &err));
    assert_done(review_json_read(path, &arena, &again, &err));
    assert_null(again.gazes[0].road);
    const GazeRoad *r = again.gazes[2].road;
    assert_same(road->mesopic_cd_m2, r->mesopic_cd_m2);
    assert_int_equal(again.gazes[2].verdict, VERDICT_FAIL);
    assert_int_equal(again.gazes[2].limit_count, 2);
    assert_true(road_has_limit(r) && r->age_count == 2 && r->dimming_count == 4);
    assert_same(30, r->ages[1].increment_pct);
    assert_same(31, r->ages[1].increment_range.high);
    assert_same(15, r->ages[1].limit.value);
    assert_string_equal(r->ages[1].displays[1].mirrored_by, "windscreen (glass)");
    assert_same(0.3, r->ages[0].displays[1].level_most_range.low);
    assert_true(isnan(r->ages[0].displays[0].level_most));
    assert_int_equal(r->dimming[0].window, ROAD_WINDOW_EMPTY);
    assert_int_equal(r->dimming[3].window, ROAD_WINDOW_NONE);
    assert_null(r->dimming[3].display);
    assert_same(0.022, r->dimming[1].level_most_range.high);
    const char *first = taken(path), *second = fresh_name(".json");
    assert_done(review_json_write(review_json(&again), second, &err));
    assert_non_null(strstr(taken(second), strstr(first, "\"road\"")));
}

TEST(a_test_of_ci_is_made_of_each_road_that_counts) {
    Review before = fixture_review(&arena), review = review_with(judged(30, 1, 0, 0));
    const char *path = fresh_name(".xml");
    assert_done(review_junit_write(&before, path, &err));
    const char *old = taken(path);
    assert_done(review_junit_write(&review, path, &err));
    const char *with = taken(path);
    int tests = review_count(&before).total;
    assert_non_null(strstr(old, arena_format(&arena, "tests=\"%d\"", tests)));
    assert_non_null(strstr(with, arena_format(&arena, "tests=\"%d\"", tests + 1)));
    assert_non_null(strstr(with, "<failure type=\"fail\" message=\"Fails: threshold increment "
                                 "30.0 +- 1.0 % (maximum 15 %), at 70 years on a road of "
                                 "0.3 cd/m2"));
    int cases = 0;
    for (const char *at = with; (at = strstr(at, "<testcase ")); at++) cases++;
    assert_int_equal(cases, tests + 1);
}

TEST(the_page_says_who_makes_it_and_what_keeps_it) {
    GazeFinding gaze = judged(30, 1, 0, 0);
    Review review = review_with(gaze), before = fixture_review(&arena);
    fixture_dimming(gaze.road);
    review_decide(&review);
    ReviewPage page = {.review = &review}, old = {.review = &before};
    const char *text = page_of(&page);
    assert_null(strstr(page_of(&old), "The road after dark"));
    assert_non_null(strstr(text, "displays make 90 % of it, wide screen 80 %, all straight"));
    assert_non_null(strstr(text, "mesopic luminance of 0.325 cd/m²"));
    assert_non_null(strstr(text, "<td class=\"bad\">empty</td>"));
}

static const char *todo_of(const GazeFinding *gaze) {
    return todo_of_finding(
        &(Finding){.gaze = gaze, .worst = &gaze->road->ages[1].limit, .verdict = gaze->verdict},
        &arena);
}

/* A level that is named keeps the limit by the end of its interval, and leaves its symbols theirs.
 */
TEST(a_road_that_fails_says_what_to_do) {
    GazeFinding found = judged(30, 1, 0, 0), *gaze = &found;
    GazeRoad *road = found.road;
    fixture_dimming(road);
    RoadDimming *row = &road->dimming[2];
    assert_string_equal(todo_of(gaze), "dim wide screen from 50 % to 3.6 %");
    row->level_least_sure = 0.04;
    assert_string_equal(
        todo_of(gaze), "no level of wide screen does both: the road allows 3.6 %, speed needs 4 %");
    row->level_most_range = (MeanInterval){0, 0};
    for (int i = 0; i < 2; i++) road->ages[1].displays[i].share = 0.2;
    assert_string_equal(todo_of(gaze),
                        "no display helps: all other light makes 18.0 % (maximum 15 %)");
    gaze->verdict = road->ages[1].limit.verdict = road->ages[0].limit.verdict = VERDICT_PASS;
    assert_string_equal(todo_of(gaze), "");
}

TEST(a_road_that_is_left_out_says_so) {
    GazeRoad *road = ARENA_NEW(&arena, GazeRoad, 1);
    *road = (GazeRoad){.luminance_cd_m2 = 0.3,
                       .s_p = NAN,
                       .mesopic_cd_m2 = NAN,
                       .left_out = ROAD_BY_DAY,
                       .without_data_share = NAN};
    Review review = review_with((GazeFinding){.sun_deg = 30, .road = road});
    ReviewPage page = {.review = &review};
    const char *text = page_of(&page);
    assert_non_null(strstr(text, "not evaluated: the sun is above the horizon"));
    assert_int_equal(review_count(&review).total, review_case_count(&review));
}

/* What an interval says and what its verdict says is one thing. */
TEST(words_say_the_ways_of_light) {
    GazeFinding gaze = judged(30, 1, 0, 0);
    RoadDisplay *first = &gaze.road->ages[1].displays[0];
    *first = gaze.road->ages[1].displays[1];
    assert_non_null(strstr(road_words(&gaze, &arena), "cluster 10 %, 60 % by windscreen (glass)"));
    first->mirrored_share = 0.1;
    first->scattered_share = 0.7;
    assert_non_null(strstr(road_words(&gaze, &arena), "70 % by surfaces that it lights"));
    assert_string_equal(road_outcome(&gaze), "fail");
}

/* The deciding age of the variant beside the review's of that age. */
TEST(a_variants_road_stands_beside_the_reviews) {
    Review before = review_with(judged(30, 1, 0, 0));
    Review after = review_with(judged(9, 1, 0, 0));
    GazeFinding only = after.gazes[2];
    int count;
    after.gazes = &only; /* a variant's has roads alone */
    after.gaze_count = 1;
    const FindingDiff *list = review_diff_beside(&before, &after, &count, &arena);
    assert_int_equal(count, 1);
    assert_int_equal(list[0].kind, DIFF_MENDED);
    assert_ptr_equal(list[0].before->gaze, &before.gazes[2]);
    const char *words = review_diff_words(&list[0], &arena);
    if (!strstr(words, "threshold increment 30 % at 70 years → 9 % at 70 years, fail → pass"))
        fail_msg("%s", words);
    only.condition = "another";
    list = review_diff_beside(&before, &after, &count, &arena);
    assert_int_equal(list[0].kind, DIFF_NEW);
    assert_null(list[0].before);
}

TEST_PROGRAM(page_begin, clear_folder)
