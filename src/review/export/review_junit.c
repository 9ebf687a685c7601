/* SPDX-License-Identifier: Apache-2.0 */
#include "review/export/review_junit.h"

#include "page/page.h"
#include "review/output/review_json.h"
#include "review/output/finding_words.h"
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

/* All cases have the same ages. */
static void set_ages(json_t *document, const Review *review) {
    json_t *ages = json_array();
    for (int i = 0; review->case_count && i < review->cases[0].visibility_count; i++) {
        char age[32];
        snprintf(age, sizeof age, "%g", review->cases[0].visibilities[i].age_years);
        json_array_append_new(ages, json_string(age));
    }
    json_object_set_new(document, "visibility_ages", ages);
}

/* What was read of a row's symbol stands beside its line; of all other kinds nothing does. */
static json_t *read_beside(const json_t *document, const Review *review, const Finding *f) {
    if (!f->c) {
        ReviewCase none = review_case_unknown();
        json_t *out = review_case_json(&none);
        json_object_set_new(out, "ambient", json_null());
        json_object_set_new(out, "display", json_null());
        return out;
    }
    const json_t *of =
        f->sweep
            ? json_object_get(json_array_get(json_object_get(document, "sweeps"),
                                             (size_t)(f->sweep - review->sweeps)),
                              "worst")
            : json_array_get(json_object_get(document, "cases"), (size_t)(f->c - review->cases));
    json_t *out = json_copy((json_t *)(size_t)of);
    return out;
}

/* Columns are the template's. A row is a line of a finding. */
bool review_csv_write(const Review *review, const char *path, Error *err) {
    Arena scratch = arena_reserve((size_t)1 << 32);
    Findings all = review_findings(review, &scratch);
    json_t *document = review_json(review);
    json_t *rows = json_object_get(document, "findings");
    static const char *const MAY_LACK[] = {"must_not_be_read", "age_years", "in_pane",
                                           "visibility_levels", NULL};
    size_t at = 0;
    for (int i = 0; i < all.count; i++) {
        int lines = all.list[i].limit_count ? all.list[i].limit_count : 1;
        for (int k = 0; k < lines; k++) {
            json_t *row = read_beside(document, review, &all.list[i]);
            for (const char *const *key = MAY_LACK; *key; key++)
                if (!json_object_get(row, *key)) page_set(row, *key, NULL);
            if (json_is_null(json_object_get(row, "visibility_levels")))
                json_object_set_new(row, "visibility_levels", json_array());
            json_object_update(row, json_array_get(rows, at));
            json_array_set_new(rows, at++, row);
        }
    }
    arena_release(&scratch);
    set_ages(document, review);
    page_set_flag(document, "has_private", review_has_privacy(review));
    return page_write_values("cases.csv", document, NULL, path, err);
}
