/* SPDX-License-Identifier: Apache-2.0 */
/* What a review says of visibility levels: as JSON, in words, beside another review. */
#include "review/export/review_junit.h"
#include "review/output/review_diff.h"
#include "review/output/review_json.h"
#include "review/output/review_todo.h"
#include "review/output/review_words.h"
#include "review_page_fixture.h"

static const char *json_of(const Review *review) {
    const char *path = fresh_name(".json");
    assert_done(review_json_write(review_json(review), path, &err));
    return taken(path);
}

/* Who has not asked for levels has no key of them, nor has a limit that is nobody's. */
TEST(levels_are_written_where_they_are) {
    Review review = fixture_review(&arena);
    assert_null(strstr(json_of(&review), "visibility_levels"));
    assert_null(strstr(json_of(&review), "\"age_years\""));
    fixture_add_levels(&arena, &review);
    const char *json = json_of(&review);
    assert_non_null(strstr(json, "\"visibility_levels\": [\n"));
    assert_non_null(strstr(json, "\"doubts\": \"a <doubt>, \\\"quoted\\\"\""));
}

/* The least of an interval, and what the figure is of, stand beside it. */
TEST(levels_are_told) {
    Review review = fixture_review(&arena);
    const ReviewCase *c = &review.cases[0];
    assert_string_equal(words_levels(c, &arena), "");
    fixture_add_levels(&arena, &review);
    assert_string_equal(words_levels(c, &arena), "visibility level 6.0 at 50 years, 3.0 at 70");
    assert_string_equal(words_level(&c->visibilities[1], &arena),
                        "3.0, 95 % interval 2.8 to 3.2; doubtful: a <doubt>, "
                        "\"quoted\"");
    assert_string_equal(words_target(&c->visibilities[0], &arena),
                        "one of its strokes, 2.25 arc minutes wide, looked at in a glance of "
                        "0.2 s; the eye adapted to 3.50 cd/m²: background, reflected light and "
                        "veil");
    assert_string_equal(words_levels(&review.cases[20], &arena), "");
}

/* The age stands behind the figure that it is of, not behind the limit. */
TEST(a_level_that_decides_names_its_age) {
    const LimitVerdict limit = {.name = "visibility level",
                                .kind = "visibility_level",
                                .unit = "1",
                                .value = 4,
                                .found = 2.9,
                                .low = 2.8,
                                .high = 3,
                                .margin = -0.275,
                                .verdict = VERDICT_FAIL,
                                .age_years = 70};
    ReviewCase c = {.limits = &limit,
                    .limit_count = 1,
                    .limit_id = -1,
                    .verdict = VERDICT_FAIL,
                    .visible_share = 1};
    assert_string_equal(words_reason(&c, &arena),
                        "visibility level 2.9 at 70 years at night (minimum 4)");
    assert_string_equal(words_judged(&c, &arena), "visibility level 2.9 at 70 years");
}

/* Of a level that nobody publishes the reason says so. */
TEST(a_level_of_no_age_is_named) {
    const LimitVerdict limit = {.name = "visibility level",
                                .kind = "visibility_level",
                                .value = 4,
                                .found = NAN,
                                .low = NAN,
                                .high = NAN,
                                .margin = NAN,
                                .verdict = VERDICT_UNJUDGED};
    const CaseVisibility level = {.age_years = 80, .level = NAN, .doubts = "too old"};
    ReviewCase c = {.limits = &limit,
                    .limit_count = 1,
                    .limit_id = -1,
                    .visible_share = 1,
                    .verdict = VERDICT_UNJUDGED,
                    .unjudged = UNJUDGED_FIGURE,
                    .visibilities = &level,
                    .visibility_count = 1};
    assert_string_equal(words_reason(&c, &arena),
                        "visibility level could not be found out: too old");
    assert_non_null(strstr(todo_of_case(&c, &arena), "an observer of an age"));
}

/* Where contrasts are the same a level that moved beyond both intervals is a change; another
 * glance is another figure. */
TEST(levels_that_moved_are_a_change) {
    Review before = fixture_review(&arena), after = fixture_review(&arena);
    fixture_add_levels(&arena, &before);
    fixture_add_levels(&arena, &after);
    ReviewDiff same = review_diff(&before, &after, "a", "b", &arena);
    assert_int_equal(same.count[DIFF_SAME], same.list_count);
    CaseVisibility *v = (CaseVisibility *)(size_t)after.cases[3].visibilities;
    v[1].level += 2;
    v[1].low += 2;
    v[1].high += 2;
    ReviewDiff diff = review_diff(&before, &after, "a", "b", &arena);
    assert_int_equal(diff.count[DIFF_BETTER], 1);
    assert_true(diff.list[0].after->c == &after.cases[3]);
    json_t *json = review_diff_json(&diff);
    json_t *lines = json_object_get(json_array_get(json_object_get(json, "findings"), 0), "lines");
    json_t *old = json_object_get(json_array_get(lines, 2), "found");
    assert_close(json_number_value(json_array_get(old, 0)), 4.5, 1e-12);
    assert_close(json_number_value(json_array_get(old, 1)), 6.5, 1e-12);
    json_decref(json);
    v[0].glance_s = v[1].glance_s = 2;
    diff = review_diff(&before, &after, "a", "b", &arena);
    assert_int_equal(diff.count[DIFF_BETTER], 0);
}

TEST(junit_tells_levels) {
    Review review = fixture_review(&arena);
    const char *path = fresh_name(".xml");
    assert_done(review_junit_write(&review, path, &err));
    assert_null(strstr(taken(path), "visibility level"));
    fixture_add_levels(&arena, &review);
    assert_done(review_junit_write(&review, path, &err));
    assert_non_null(strstr(taken(path), "visibility level 6.0 at 50 years, 3.0 at 70"
                                        "</system-out>"));
}

TEST_PROGRAM(page_begin, clear_folder)
