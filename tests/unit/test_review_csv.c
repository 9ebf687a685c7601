/* SPDX-License-Identifier: Apache-2.0 */
/* What spreadsheets get from a review, whatever the names are. */
#include "print/printable.h"
#include "review/export/review_junit.h"
#include "review/finding.h"
#include "review_page_fixture.h"

enum { CSV_COLUMNS = 54, CSV_COLUMNS_MOST = 64 };

/* One record of RFC 4180 into cells; what follows it. */
static const char *read_record(const char *at, const char *cell[CSV_COLUMNS_MOST], int *count) {
    for (*count = 0;; at++) {
        Text text = {.arena = &arena};
        bool quoted = *at == '"';
        text_add(&text, "");
        for (at += quoted; quoted ? *at != '"' || at[1] == '"' : !strchr(",\r\n", *at); at++) {
            assert_true(*at && (quoted || *at != '"'));
            text_add_bytes(&text, at, 1);
            at += quoted && *at == '"';
        }
        at += quoted;
        assert_true(*count < CSV_COLUMNS_MOST);
        cell[(*count)++] = text.data ? text.data : "";
        if (*at != ',') break;
    }
    assert_true(at[0] == '\r' && at[1] == '\n');
    return at + 2;
}

/* A cell has a name as it may be shown. NULL: "". */
static void assert_names(const char *cell, const char *name) {
    Arena scratch = arena;
    assert_string_equal(cell, arena_printable(&scratch, name ? name : ""));
}

static double number_of(const char *cell) {
    char *end = NULL;
    double value = strtod(cell, &end);
    assert_true(*end == 0);
    return *cell ? value : NAN;
}

/* The cell of a record below a name of the header. */
static const char *below(const char *const *header, const char *const *cell, const char *name) {
    for (int i = 0; i < CSV_COLUMNS; i++)
        if (!strcmp(header[i], name)) return cell[i];
    fail_msg("no column is called %s", name);
    return "";
}

static void assert_symbol(const char *const *header, const char *const *cell, const ReviewCase *c) {
    assert_same(c->luminance_cd_m2.reflected, number_of(below(header, cell, "reflected_cd_m2")));
    assert_same(c->contrast_ratio, number_of(below(header, cell, "contrast_ratio_without_veil")));
    assert_same(c->eye_failed_share, number_of(below(header, cell, "eye_failed_share")));
    assert_names(below(header, cell, "hidden_by"), c->hider_count ? c->hiders[0].what : NULL);
    assert_same(c->hider_count ? c->hiders[0].share : (double)NAN,
                number_of(below(header, cell, "hidden_by_share")));
    assert_same(c->stroke_ratio, number_of(below(header, cell, "stroke_ratio")));
    assert_same(c->whole.reflected, number_of(below(header, cell, "mean_reflected_cd_m2")));
    assert_same(c->whole.contrast_ratio, number_of(below(header, cell, "mean_contrast_ratio")));
    assert_same(c->whole.lit_share, number_of(below(header, cell, "lit_share")));
}

/* Every finding, each with a row for each of its lines. */
static void assert_csv_says(const Review *review) {
    const char *path = in_folder("t.csv"), *header[CSV_COLUMNS_MOST], *cell[CSV_COLUMNS_MOST];
    Findings all = review_findings(review, &arena);
    int count = 0;
    assert_done(review_csv_write(review, path, &err));
    const char *at = read_record(taken(path), header, &count);
    assert_int_equal(count, CSV_COLUMNS);
    for (int i = 0; i < all.count; i++) {
        const Finding *f = &all.list[i];
        for (int k = 0; k < f->limit_count || k == 0; k++) {
            const LimitVerdict *line = f->limit_count ? &f->limits[k] : NULL;
            at = read_record(at, cell, &count);
            assert_int_equal(count, CSV_COLUMNS);
            assert_names(below(header, cell, "condition"), f->condition);
            assert_names(below(header, cell, "subject"), f->subject);
            assert_string_equal(below(header, cell, "kind"), finding_kind(f));
            assert_string_equal(below(header, cell, "finding_verdict"), verdict_names[f->verdict]);
            assert_string_equal(below(header, cell, "reason"),
                                f->why ? unjudged_names[f->why] : "");
            assert_same(line ? line->found : (double)NAN, number_of(below(header, cell, "found")));
            assert_same(line ? line->high : (double)NAN,
                        number_of(below(header, cell, "found_high")));
            assert_same(line ? line->margin : (double)NAN,
                        number_of(below(header, cell, "margin")));
            assert_string_equal(below(header, cell, "verdict"),
                                verdict_names[line ? line->verdict : f->verdict]);
            assert_string_equal(below(header, cell, "decides"),
                                line == f->worst ? "true" : "false");
            if (f->c) assert_symbol(header, cell, f->c);
        }
    }
    assert_int_equal(*at, 0);
}

TEST(csv_says_the_same) {
    Review odd = fixture_odd_review(&arena), plain = fixture_review(&arena), none = {0};
    assert_csv_says(&odd);
    assert_csv_says(&plain);
    assert_csv_says(&none);
}

/* Four columns an age, behind all others; nothing of a symbol that is hidden. */
TEST(csv_has_columns_of_levels) {
    Review review = fixture_review(&arena);
    const char *path = in_folder("t.csv"), *cell[CSV_COLUMNS_MOST];
    int count = 0;
    fixture_add_levels(&arena, &review);
    assert_done(review_csv_write(&review, path, &err));
    const char *at = read_record(taken(path), cell, &count);
    assert_int_equal(count, CSV_COLUMNS + 8);
    assert_string_equal(cell[CSV_COLUMNS], "visibility_level_50_years");
    assert_string_equal(cell[CSV_COLUMNS + 5], "visibility_low_70_years");
    for (int i = 0; i < review.case_count; i++) {
        const CaseVisibility *v = review.cases[i].visibilities;
        int rows = review.cases[i].limit_count;
        for (int k = 0; k < rows || k == 0; k++) at = read_record(at, cell, &count);
        assert_int_equal(count, CSV_COLUMNS + 8);
        assert_same(v[0].level, number_of(cell[CSV_COLUMNS]));
        assert_same(v[1].low, number_of(cell[CSV_COLUMNS + 5]));
        assert_same(v[1].high, number_of(cell[CSV_COLUMNS + 6]));
        assert_names(cell[CSV_COLUMNS + 7], v[1].doubts);
    }
}

TEST_PROGRAM(page_begin, clear_folder)
