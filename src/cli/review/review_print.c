/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/review/review_print.h"

#include <ctype.h>
#include <string.h>

#include "print/print.h"
#include "cli/options/answer.h"
#include "review/output/review_diff.h"
#include "review/output/review_facts.h"
#include "review/output/review_gaze.h"
#include "review/output/review_json.h"
#include "review/output/review_road.h"
#include "review/output/review_todo.h"
#include "review/output/finding_words.h"
#include "review/output/review_variants.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "review/terms.h"
#include "text/interval_text.h"

/* A row has one quantity: that of the limit which decides it. */
static void print_judged(const ReviewCase *c, Arena *scratch) {
    const LimitVerdict *limit = case_worst_limit(c);
    if (c->unjudged && c->unjudged != UNJUDGED_PANEL && c->unjudged != UNJUDGED_DATA) {
        print(": %s", words_unjudged(c, scratch));
        return;
    }
    if (!limit) return;
    print(": %s %s", words_kind(limit), words_measured(limit, scratch));
    print(" (%s)", words_bound(limit, scratch));
    if (c->unjudged) print("; %s", words_unjudged(c, scratch));
}

/* All figures are of the worst part. */
static void print_whole(const ReviewCase *c, Arena *scratch) {
    const char *whole = words_whole(c, scratch);
    if (*whole) print("; of the worst part, %s", whole);
}

static void print_levels(const ReviewCase *c, Arena *scratch) {
    const char *levels = words_levels(c, scratch);
    if (*levels) print("; %s", levels);
}

static void print_case(const ReviewCase *c, Arena scratch) {
    print("%-16s %s, %s, %s", verdict_names[c->verdict], c->condition, c->eye, c->symbol);
    print_judged(c, &scratch);
    if (case_is_seen(c))
        print(", reflected %s cd/m2",
              interval_text(c->luminance_cd_m2.reflected, c->reflected_range.low,
                            c->reflected_range.high, &scratch));
    print_whole(c, &scratch);
    print_levels(c, &scratch);
    if (c->hider_count && case_is_seen(c)) print(TERM_HIDDEN_BY "%s", words_hiders(c, &scratch));
    const char *decide = words_decide(c, &scratch);
    print("%s%s%s\n", words_precision(c, &scratch), *decide ? "; " : "", decide);
}

static void print_sweep(const ReviewSweep *s, Arena scratch) {
    bool is_sure = sweep_verdict(s) == VERDICT_FAIL || !(s->failed_share > 0);
    print("%-16s %s, %s, %s: %sfails: %s%s", verdict_names[sweep_verdict(s)], s->condition, s->eye,
          s->symbol, sweep_has_box(s) ? "middle eye " : "", words_failing(s, &scratch),
          is_sure ? "" : " by its steps alone, in none that was read again");
    print("; %ld suns judged%s", s->cases, words_sweep_colour(s));
    if (sweep_has_box(s) && s->middle_contrast > 0)
        print("; at its own worst %s", words_ratio_as(&s->worst, s->middle_contrast, &scratch));
    if (sweep_has_box(s))
        print("; at the worst sun %s of eyes fail",
              words_share(s->worst.eye_failed_share, &scratch));
    if (s->worst.has_sun)
        print("; worst at azimuth %.1f, elevation %.1f", s->worst.sun_azimuth_deg,
              s->worst.sun_elevation_deg);
    print_judged(&s->worst, &scratch);
    print_whole(&s->worst, &scratch);
    print_levels(&s->worst, &scratch);
    print("%s", words_precision(&s->worst, &scratch));
    print("\n");
}

/* Prints a gaze that keeps less than half of the contrast. */
static void print_gaze(const GazeFinding *g, Arena scratch) {
    if (!(g->contrast_left < GAZE_POOR)) return;
    print("%-16s %s, %s, looking at %s: %.3g %% of a distant object's contrast left; seen "
          "%.4g cd/m2, mirrored by glass %s, veil in the eye %s\n",
          "veiled", g->condition, g->eye, g->gaze, 100 * g->contrast_left, g->through,
          review_gaze_mirrored(g, &scratch), review_gaze_veil(g, &scratch));
}

/* A gaze at a road without a verdict. */
static void print_road(const GazeFinding *g, Arena scratch) {
    if (!g->road || g->limit_count) return;
    print("%-16s %s, %s, looking at %s: %s\n", road_outcome(g), g->condition, g->eye, g->gaze,
          road_words(g, &scratch));
}

/* What is judged besides symbols. */
static void print_finding(const Finding *f, Arena scratch) {
    const char *todo = todo_of_finding(f, &scratch);
    if (f->c) return;
    print("%-16s %s, %s, %s: %s\n", verdict_names[f->verdict], f->condition, f->viewer, f->subject,
          finding_reason(f, &scratch));
    if (*todo) print("%-16s %s\n", "what to do", todo);
}

/* How many displays stand in glass in all. */
static void print_panes(const Review *review) {
    int shown = 0;
    for (int i = 0; i < review->pane_image_count; i++) shown += !review->pane_images[i].none;
    if (review->pane_image_count)
        print("%-16s %d image%s of displays in glass\n", "panes", shown, shown == 1 ? "" : "s");
}

static void print_variant(const Review *review, const ReviewVariantFound *v, Arena scratch) {
    print("%-16s variant %s: %s\n", verdict_names[review_verdict(v->review)], v->name,
          review_variants_words(v, &scratch));
    int count;
    const FindingDiff *beside = review_diff_beside(review, v->review, &count, &scratch);
    for (int i = 0; i < count; i++)
        print("%-16s variant %s: %s\n",
              beside[i].after->counts ? verdict_names[beside[i].after->verdict] : "no limit",
              v->name, review_diff_words(&beside[i], &scratch));
}

static void print_fact(const ReviewFact *fact) {
    print("%c%-15s %s\n", tolower((unsigned char)fact->name[0]), fact->name + 1, fact->value);
}

/* The first screen of the page, as lines: of all findings the one that decides. */
static void print_worst(const Review *review, const Finding *worst, Arena scratch) {
    ReviewFacts facts = review_facts_of(review, worst, NULL, &scratch);
    print("%-16s %s: %s\n", "worst case",
          words_named(worst->subject, worst->viewer, worst->condition, &scratch),
          worst->c ? words_headline(worst->c, &scratch) : finding_reason(worst, &scratch));
    for (int i = 0; i < facts.count; i++) print_fact(&facts.list[i]);
}

static void print_review(const Review *review, Arena scratch) {
    for (int i = 0; i < review->case_count; i++) print_case(&review->cases[i], scratch);
    for (int i = 0; i < review->sweep_count; i++) print_sweep(&review->sweeps[i], scratch);
    for (int i = 0; i < review->gaze_count; i++) print_gaze(&review->gazes[i], scratch);
    for (int i = 0; i < review->gaze_count; i++) print_road(&review->gazes[i], scratch);
    Findings all = review_findings(review, &scratch), ranked = review_ranked(review, &scratch);
    for (int i = 0; i < all.count; i++) print_finding(&all.list[i], scratch);
    print_panes(review);
    for (int i = 0; i < review->variant_count; i++)
        print_variant(review, &review->variants[i], scratch);
    if (ranked.count) print_worst(review, &ranked.list[0], scratch);
    const char *rests = review_rests_words(review, true, &scratch);
    if (rests[0]) print("%-16s %s\n", "rests on", rests);
    print("%s\n", review_outcome_words(review, &scratch));
}

bool review_print(const Cli *cli, const Review *review, Arena scratch, Error *err) {
    if (cli->json) return cli_print_json(review_json(review), err);
    print_review(review, scratch);
    return true;
}
