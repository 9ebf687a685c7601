/* SPDX-License-Identifier: Apache-2.0 */
#include "review/export/review_junit.h"

#include "page/page.h"
#include "review/output/review_json.h"
#include "review/output/finding_words.h"
#include "review/output/review_road.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"

static json_t *causes_values(const ReviewCase *c, Arena scratch) {
    json_t *list = json_array();
    for (int i = 0; c && i < c->cause_count; i++) {
        json_t *to = page_add(list);
        page_set(to, "share", words_share(c->causes[i].share, &scratch));
        page_set(to, "chain", words_chain(&c->causes[i], &scratch));
    }
    return list;
}

/* Only a verdict that fails the review is a failure; what cannot be judged is an error: the
 * test could not be made. */
static void add_finding(json_t *list, const Review *review, const Finding *f, Arena scratch) {
    json_t *to = page_add(list);
    bool is_error = f->verdict == VERDICT_UNJUDGED && f->counts;
    bool fails =
        f->verdict == VERDICT_FAIL || (review->is_strict && f->verdict == VERDICT_TOO_CLOSE);
    page_set(to, "name", finding_name(f, &scratch));
    page_set(to, "verdict", verdict_names[f->verdict]);
    page_set(to, "outcome", words_verdict(f->verdict));
    page_set(to, "reason", finding_reason(f, &scratch));
    page_set(to, "sun", f->c ? words_sun(f->c, NULL, &scratch) : "");
    page_set(to, "levels", f->c ? words_levels(f->c, &scratch) : NULL);
    page_set_flag(to, "is_error", is_error);
    page_set_flag(to, "is_failure", fails);
    page_set_flag(to, "is_skipped", !is_error && !fails && f->verdict != VERDICT_PASS);
    json_object_set_new(to, "causes", causes_values(f->c, scratch));
}

bool review_junit_write(const Review *review, const char *path, Error *err) {
    Arena own = arena_reserve((size_t)1 << 32);
    Findings all = review_findings(review, &own);
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
    for (int i = 0; i < all.count; i++) add_finding(tests, review, &all.list[i], own);
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
