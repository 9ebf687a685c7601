/* SPDX-License-Identifier: Apache-2.0 */
#include "review/export/review_junit.h"

#include "page/page.h"
#include "review/output/review_json.h"
#include "review/output/review_road.h"
#include "review/output/review_panes.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"

/* Only a verdict that fails the review is a failure; what cannot be judged is an error: the
 * test could not be made. */
static bool is_failure(const Review *review, Verdict verdict) {
    return verdict == VERDICT_FAIL || (review->is_strict && verdict == VERDICT_TOO_CLOSE);
}

static json_t *causes_values(const ReviewCase *c, Arena scratch) {
    json_t *list = json_array();
    for (int i = 0; i < c->cause_count; i++) {
        json_t *to = page_add(list);
        page_set(to, "share", words_share(c->causes[i].share, &scratch));
        page_set(to, "chain", words_chain(&c->causes[i], &scratch));
    }
    return list;
}

/* name: of the test case. */
static void add_case(json_t *list, const Review *review, const ReviewCase *c, const char *name,
                     Arena scratch) {
    json_t *to = page_add(list);
    bool is_error = c->verdict == VERDICT_UNJUDGED && review_case_counts(c);
    bool fails = is_failure(review, c->verdict) && !is_error;
    page_set(to, "name", name);
    page_set(to, "verdict", verdict_names[c->verdict]);
    page_set(to, "outcome", words_verdict(c->verdict));
    page_set(to, "reason", words_reason(c, &scratch));
    page_set(to, "sun", words_sun(c, NULL, &scratch));
    page_set(to, "levels", words_levels(c, &scratch));
    page_set_flag(to, "is_error", is_error);
    page_set_flag(to, "is_failure", fails);
    page_set_flag(to, "is_skipped", !is_error && !fails && c->verdict != VERDICT_PASS);
    json_object_set_new(to, "causes", causes_values(c, scratch));
}

/* A gaze at a road whose threshold increment has a limit. */
static void add_road(json_t *list, const Review *review, const GazeFinding *gaze, Arena scratch) {
    Verdict verdict = gaze->road->verdict;
    json_t *to = page_add(list);
    bool is_error = verdict == VERDICT_UNJUDGED, fails = is_failure(review, verdict);
    page_set(to, "name", road_name(gaze, &scratch));
    page_set(to, "verdict", verdict_names[verdict]);
    page_set(to, "outcome", words_verdict(verdict));
    page_set(to, "reason", road_words(gaze, &scratch));
    page_set(to, "sun", "");
    page_set_flag(to, "is_error", is_error);
    page_set_flag(to, "is_failure", fails);
    page_set_flag(to, "is_skipped", !is_error && !fails && verdict != VERDICT_PASS);
    json_object_set_new(to, "causes", json_array());
}

/* A display in glass that the request has a limit for. */
static void add_pane(json_t *list, const Review *review, const PaneFinding *f, Arena scratch) {
    Verdict verdict = f->limit.verdict;
    json_t *to = page_add(list);
    bool is_error = verdict == VERDICT_UNJUDGED, fails = is_failure(review, verdict);
    page_set(to, "name", review_pane_name(f, &scratch));
    page_set(to, "verdict", verdict_names[verdict]);
    page_set(to, "outcome", words_verdict(verdict));
    page_set(to, "reason", review_pane_words(f, &scratch));
    page_set(to, "sun", "");
    page_set_flag(to, "is_error", is_error);
    page_set_flag(to, "is_failure", fails);
    page_set_flag(to, "is_skipped", !is_error && !fails && verdict != VERDICT_PASS);
    json_object_set_new(to, "causes", json_array());
}

static const char *sweep_name(const ReviewSweep *s, Arena *arena) {
    return arena_format(arena, "%s (worst of %ld, fails: %s%s)", words_case(&s->worst, arena),
                        s->cases, words_failing(s, arena), sweep_has_box(s) ? ", middle eye" : "");
}

bool review_junit_write(const Review *review, const char *path, Error *err) {
    Arena own = arena_reserve((size_t)1 << 24);
    ReviewCounts counts = review_count(review);
    int close = counts.of[VERDICT_TOO_CLOSE];
    json_t *values = json_object(), *tests = json_array();
    page_set(values, "version", PARHELION_VERSION);
    page_set(values, "title", review->title ? review->title : "review");
    page_set(values, "profile", review->profile);
    page_set_count(values, "count", counts.total);
    page_set_count(values, "failures", counts.of[VERDICT_FAIL] + (review->is_strict ? close : 0));
    page_set_count(values, "errors", counts.of[VERDICT_UNJUDGED]);
    page_set_count(values, "skipped", counts.not_asked + (review->is_strict ? 0 : close));
    json_object_set_new(values, "tests", tests);
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        const ReviewSweep *sweep = review_sweep_of(review, c);
        Arena scratch = own;
        const char *name = sweep ? sweep_name(sweep, &scratch) : words_case(c, &scratch);
        add_case(tests, review, c, name, scratch);
    }
    for (int i = 0; i < review->gaze_count; i++)
        if (gaze_counts(&review->gazes[i])) add_road(tests, review, &review->gazes[i], own);
    for (int i = 0; i < review->pane_image_count; i++)
        if (pane_counts(&review->pane_images[i]))
            add_pane(tests, review, &review->pane_images[i], own);
    bool ok = page_write_values("review_junit.xml", values, NULL, path, err);
    arena_release(&own);
    return ok;
}

/* ---- as tables --------------------------------------------------------------------------- */

/* All cases have the same ages; the document leaves empty lists out. */
static void set_ages(json_t *document, const Review *review) {
    json_t *ages = json_array(), *cases = json_object_get(document, "cases");
    for (int i = 0; review->case_count && i < review->cases[0].visibility_count; i++) {
        char age[32];
        snprintf(age, sizeof age, "%g", review->cases[0].visibilities[i].age_years);
        json_array_append_new(ages, json_string(age));
    }
    json_object_set_new(document, "visibility_ages", ages);
    for (size_t i = 0; i < json_array_size(cases); i++) {
        json_t *to = json_array_get(cases, i);
        if (!json_object_get(to, "visibility_levels"))
            json_object_set_new(to, "visibility_levels", json_array());
    }
}

/* Columns are the templates': assets/pages/cases.csv and the others. */
bool review_csv_write(const Review *review, const char *path, Error *err) {
    json_t *document = review_json(review);
    set_ages(document, review);
    page_set_flag(document, "has_private", review_has_privacy(review));
    page_set(document, "must_not_be_read", NULL); /* of cases without it */
    page_set(document, "by_pane", NULL);          /* of limits about the symbol itself */
    return page_write_values("cases.csv", document, NULL, path, err);
}

bool review_csv_write_false_suns(const Review *review, const char *path, Error *err) {
    return page_write_values("false_suns.csv", review_json(review), NULL, path, err);
}

bool review_csv_write_gazes(const Review *review, const char *path, Error *err) {
    json_t *document = review_json(review);
    road_add_columns(document, review);
    return page_write_values("gazes.csv", document, NULL, path, err);
}

bool review_csv_write_dimming(const Review *review, const char *path, Error *err) {
    json_t *document = review_json(review);
    road_add_columns(document, review);
    return page_write_values("dimming.csv", document, NULL, path, err);
}

bool review_csv_write_pane_images(const Review *review, const char *path, Error *err) {
    return page_write_values("pane_images.csv", review_json(review), NULL, path, err);
}
