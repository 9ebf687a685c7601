/* SPDX-License-Identifier: Apache-2.0 */
#include "review/export/review_junit.h"

#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/text.h"

/* Only a verdict that fails the review is a failure; what cannot be judged is an error: the
 * test could not be made. */
static bool is_failure(const Review *review, Verdict verdict)
{
    return verdict == VERDICT_FAIL || (review->is_strict && verdict == VERDICT_TOO_CLOSE);
}

static void add_attribute(Text *xml, const char *name, const char *value)
{
    text_format(xml, " %s=\"", name);
    escape_markup(xml, value);
    text_add(xml, "\"");
}

static void add_causes(Text *xml, const ReviewCase *c, Arena *arena)
{
    for (int i = 0; i < c->cause_count; i++) {
        escape_markup(xml, arena_format(arena, "%s of the reflected light: ",
                                        words_share(c->causes[i].share, arena)));
        escape_markup(xml, words_chain(&c->causes[i], arena));
        text_add(xml, "\n");
    }
}

/* name: of the test case; verdict: its own, for a sweep may fail where its worst passes. */
static void add_case(Text *xml, const Review *review, const ReviewCase *c, const char *name,
                     Verdict verdict)
{
    Arena arena = arena_reserve((size_t)1 << 24);
    const char *reason = arena_format(&arena, "%s: %s", words_verdict(verdict),
                                      words_reason(c, &arena));
    text_add(xml, "  <testcase classname=\"parhelion.review\"");
    add_attribute(xml, "name", name);
    text_add(xml, " time=\"0\">\n");
    bool is_error = verdict == VERDICT_UNJUDGED && review_case_counts(c);
    if (is_failure(review, verdict) || is_error) {
        text_format(xml, "    <%s", is_error ? "error" : "failure");
        add_attribute(xml, "type", verdict_names[verdict]);
        add_attribute(xml, "message", reason);
        text_add(xml, ">");
        add_causes(xml, c, &arena);
        text_add(xml, is_error ? "</error>\n" : "</failure>\n");
    } else if (verdict != VERDICT_PASS) {
        text_add(xml, "    <skipped");
        add_attribute(xml, "message", reason);
        text_add(xml, "/>\n");
    }
    text_add(xml, "    <system-out>");
    escape_markup(xml, reason);
    text_add(xml, "\n");
    escape_markup(xml, words_sun(c, NULL, &arena));
    text_add(xml, "</system-out>\n  </testcase>\n");
    arena_release(&arena);
}

static void add_sweep(Text *xml, const Review *review, const ReviewSweep *s)
{
    Arena       arena = arena_reserve((size_t)1 << 20);
    const char *name = arena_format(&arena, "%s (worst of %ld, %s %s fails%s)",
                                    words_case(&s->worst, &arena), s->cases,
                                    words_share(s->failed_share, &arena), words_of_what(s),
                                    sweep_has_box(s) ? " for the middle eye" : "");
    add_case(xml, review, &s->worst, name, sweep_verdict(s));
    arena_release(&arena);
}

static void add_counts(Text *xml, const Review *review)
{
    ReviewCounts counts = review_count(review);
    int close = counts.of[VERDICT_TOO_CLOSE];
    int failures = counts.of[VERDICT_FAIL] + (review->is_strict ? close : 0);
    text_format(xml, " tests=\"%d\" failures=\"%d\" errors=\"%d\" skipped=\"%d\" time=\"0\"",
                counts.total, failures, counts.of[VERDICT_UNJUDGED],
                counts.not_asked + (review->is_strict ? 0 : close));
}

bool review_junit_write(const Review *review, const char *path, Error *err)
{
    Arena arena = arena_reserve((size_t)1 << 30), names = arena_reserve((size_t)1 << 24);
    Text  xml = {.arena = &arena};
    text_add(&xml, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites");
    add_counts(&xml, review);
    text_add(&xml, ">\n<testsuite");
    add_attribute(&xml, "name", review->title ? review->title : "review");
    add_counts(&xml, review);
    text_format(&xml, ">\n  <properties>\n    <property name=\"software\" "
                "value=\"parhelion %s\"/>\n    <property name=\"profile\"", PARHELION_VERSION);
    add_attribute(&xml, "value", review->profile ? review->profile : "");
    text_add(&xml, "/>\n  </properties>\n");
    for (int i = 0; i < review->case_count; i++) {
        const ReviewCase *c = &review->cases[i];
        add_case(&xml, review, c, words_case(c, &names), c->verdict);
    }
    for (int i = 0; i < review->sweep_count; i++) add_sweep(&xml, review, &review->sweeps[i]);
    text_add(&xml, "</testsuite>\n</testsuites>\n");
    bool ok = text_write(&xml, path, err);
    arena_release(&names);
    arena_release(&arena);
    return ok;
}
