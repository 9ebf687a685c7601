/* SPDX-License-Identifier: Apache-2.0 */
/* Displays in glass: what is said of them agrees in every figure, and decides the review. */
#include "review/export/review_junit.h"
#include "review/finding.h"
#include "review/output/review_json.h"
#include "review/output/review_page.h"
#include "review/output/review_rays.h"
#include "review/review_decide.h"
#include "pane_fixture.h"
#include "review_page_fixture.h"

/* ---- figures ----------------------------------------------------------------------------- */

TEST(contrast_is_the_quotient_and_its_ends_are_both_doubts) {
    PaneFinding f = fixture_pane("a");
    assert_close(f.contrast, 0.25, 1e-12);
    double low = hypot(0.25 - 0.9 / 4, 0.25 - 1 / 4.4);
    double high = hypot(1.1 / 4 - 0.25, 1 / 3.6 - 0.25);
    assert_close(f.contrast_range.low, 0.25 - low, 1e-12);
    assert_close(f.contrast_range.high, 0.25 + high, 1e-12);
}

/* Limits below, in and above the interval, 0.216 to 0.287. */
TEST(a_verdict_follows_from_interval_and_limit) {
    static const double LIMITS[] = {0.2, 0.25, 0.26, 0.3};
    static const Verdict WANTED[] = {VERDICT_FAIL, VERDICT_TOO_CLOSE, VERDICT_TOO_CLOSE,
                                     VERDICT_PASS};
    for (int i = 0; i < 4; i++) {
        PaneFinding f = fixture_pane("a");
        assert_false(f.has_limit);
        fixture_pane_judge(&f, LIMITS[i]);
        assert_true(f.has_limit);
        assert_int_equal(f.limit.verdict, WANTED[i]);
        assert_near(f.limit.margin, log1p(LIMITS[i]) / log1p(0.25) - 1, 1e-6);
    }
}

TEST(an_image_before_nothing_fails_any_limit) {
    PaneFinding f = fixture_pane("a");
    f.against = 0;
    f.against_range = (MeanInterval){0, 0};
    pane_set_contrast(&f);
    fixture_pane_judge(&f, 1e6);
    assert_true(isinf(f.contrast));
    assert_int_equal(f.limit.verdict, VERDICT_FAIL);
    f.image = 0;
    f.image_range = (MeanInterval){0, 0};
    pane_set_contrast(&f);
    fixture_pane_judge(&f, 0.1);
    assert_true(f.contrast == 0);
    assert_int_equal(f.limit.verdict, VERDICT_PASS);
}

/* ---- the review -------------------------------------------------------------------------- */

/* One case that passes, and these. */
static Review review_of(PaneFinding *list, int count) {
    Review review = fixture_review(&arena);
    review.cases = ARENA_NEW(&arena, ReviewCase, 1);
    review.cases[0] = review_case_unknown();
    review.cases[0].condition = "night";
    review.cases[0].eye = "driver";
    review.cases[0].symbol = "speed";
    review.cases[0].verdict = VERDICT_PASS;
    review.cases[0].unjudged = UNJUDGED_NOT;
    review.case_count = 1;
    review.sweep_count = review.false_sun_count = review.gaze_count = 0;
    review.is_strict = false;
    review.pane_images = list;
    review.pane_image_count = count;
    review_decide(&review);
    return review;
}

TEST(what_counts_decides_the_review) {
    PaneFinding list[] = {fixture_pane_hidden(), fixture_pane("near"), fixture_pane("far")};
    Review review = review_of(list, 3);
    assert_true(review.pass);
    assert_int_equal(review_count(&review).total, 1);
    fixture_pane_judge(&list[1], 0.26);
    review_decide(&review);
    assert_int_equal(review_verdict(&review), VERDICT_TOO_CLOSE);
    fixture_pane_judge(&list[2], 0.1);
    assert_false(review_decide(&review));
    assert_int_equal(review_verdict(&review), VERDICT_FAIL);
    assert_ptr_equal(review_ranked(&review, &arena).list[0].pane, &list[2]);
    assert_int_equal(review_count(&review).total, 3);
}

/* ---- files ------------------------------------------------------------------------------- */

static void assert_same_finding(const PaneFinding *a, const PaneFinding *b) {
    assert_same(a->shown_share, b->shown_share);
    assert_same(a->covered_share, b->covered_share);
    assert_string_equal(a->display, b->display);
    assert_string_equal(a->none ? a->none : "", b->none ? b->none : "");
    assert_int_equal(a->outline_count, b->outline_count);
    for (int i = 0; i < a->outline_count; i++) assert_same(a->outline_deg[i], b->outline_deg[i]);
    assert_same(a->image_range.high, b->image_range.high);
    assert_same(a->behind, b->behind);
    assert_same(a->contrast, b->contrast);
    assert_same(a->contrast_range.low, b->contrast_range.low);
    assert_same(a->off_deg, b->off_deg);
    assert_same(a->ghost_arcmin, b->ghost_arcmin);
    assert_int_equal(a->has_limit, b->has_limit);
    if (a->has_limit) assert_int_equal(a->limit.verdict, b->limit.verdict);
}

TEST(review_json_keeps_them_and_others_have_no_such_key) {
    PaneFinding list[] = {fixture_pane_hidden(), fixture_pane("near")};
    const char *path = fresh_name(".json");
    Review review = review_of(list, 2), again;
    fixture_pane_judge(&list[1], 0.1);
    assert_done(review_json_write(review_json(&review), path, &err));
    assert_done(review_json_read(path, &arena, &again, &err));
    assert_int_equal(again.pane_image_count, 2);
    for (int i = 0; i < 2; i++) assert_same_finding(&list[i], &again.pane_images[i]);
    review = review_of(NULL, 0);
    assert_done(review_json_write(review_json(&review), path, &err));
    assert_null(strstr(taken(path), "pane_images"));
}

TEST(every_output_has_the_same_figures) {
    PaneFinding list[] = {fixture_pane_hidden(), fixture_pane("near \"screen\"")};
    Review review = review_of(list, 2);
    fixture_pane_judge(&list[1], 0.1);
    review_decide(&review);
    const char *path = fresh_name(".xml");
    assert_done(review_junit_write(&review, path, &err));
    const char *junit = taken(path);
    assert_non_null(strstr(junit, "tests=\"2\" failures=\"1\""));
    assert_non_null(strstr(junit, "seen by driver, night"));
    assert_null(strstr(junit, "side &lt;glass&gt;"));
    ReviewPage page = {.review = &review};
    const char *html = page_of(&page);
    assert_non_null(strstr(html, "Displays in glass"));
    assert_non_null(strstr(html, "9.0° up, 8.0° left"));
    assert_non_null(strstr(html, "side &lt;glass&gt;: the pane ends before it"));
    review = review_of(NULL, 0);
    assert_null(strstr(page_of(&page), "Displays in glass"));
}

/* Ahead and to the left, in a picture of 90 degrees. */
TEST(outlines_lie_over_a_frame_where_its_view_has_them) {
    static const Vec3 CORNERS[] = {{-0.5f, 0.25f, -1}, {0, 0.25f, -1}, {0, 0.5f, -1}};
    CaseView view = {.right = {1, 0, 0},
                     .up = {0, 1, 0},
                     .forward = {0, 0, -1},
                     .is_perspective = true,
                     .half_width = 1,
                     .half_height = 0.5,
                     .width = 200,
                     .height = 100};
    PaneFinding list[] = {fixture_pane_hidden(), fixture_pane("near")};
    Review review = review_of(list, 2);
    list[1].corners = CORNERS;
    list[1].corner_count = 3;
    assert_null(review_panes_drawn(&review, &review.cases[0], &arena));
    review.cases[0].view = &view;
    const char *drawn = review_panes_drawn(&review, &review.cases[0], &arena);
    assert_non_null(drawn);
    assert_non_null(strstr(drawn, "M50.0 25.0L100.0 25.0L100.0 0.0Z"));
    review.cases[0].eye = "passenger";
    assert_null(review_panes_drawn(&review, &review.cases[0], &arena));
}

TEST_PROGRAM(page_begin, clear_folder)
