/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_diff.h"

#include <math.h>
#include <stddef.h>

#include "review/output/review_words.h"
#include "review/private_image.h"
#include "review/review_decide.h"
#include "text/json_text.h"

const char *const diff_names[7] = {"broken", "mended", "worse", "better", "gone", "new", "same"};

const GazeFinding diff_no_gaze = {.contrast_left = NAN, .mirrored = NAN, .veil = NAN};

#define LEAST_SHARE 0.0005 /* of time: below it a sweep counts as the same */

/* ---- what changed ----------------------------------------------------------------------- */

/* Nothing is worse than a symbol that has come to be hidden. */
static DiffKind verdict_change(Verdict before, Verdict after) {
    static const int BADNESS[4] = {
        [VERDICT_PASS] = 0, [VERDICT_TOO_CLOSE] = 1, [VERDICT_FAIL] = 2, [VERDICT_UNJUDGED] = 3};
    int more = BADNESS[after] - BADNESS[before];
    return more > 0 ? DIFF_BROKEN : more < 0 ? DIFF_MENDED : DIFF_SAME;
}

/* The same person's, in as long a glance; NULL: there is none. */
static const CaseVisibility *level_like(const ReviewCase *c, const CaseVisibility *like) {
    for (int i = 0; c && i < c->visibility_count; i++) {
        const CaseVisibility *v = &c->visibilities[i];
        if (v->age_years == like->age_years && v->glance_s == like->glance_s) return v;
    }
    return NULL;
}

/* Contrast moved only where the intervals do not touch: two runs of one design differ by their
 * noise. */
static DiffKind contrast_change(const ReviewCase *before, const ReviewCase *after) {
    bool is_private = after->must_not_be_read; /* the less contrast, the better */
    if (after->contrast_high < before->contrast_low) return is_private ? DIFF_BETTER : DIFF_WORSE;
    if (after->contrast_low > before->contrast_high) return is_private ? DIFF_WORSE : DIFF_BETTER;
    return DIFF_SAME;
}

static const CaseImage *image_like(const ReviewCase *c, const CaseImage *like) {
    for (int i = 0; i < c->image_count; i++)
        if (words_same(c->images[i].pane, like->pane)) return &c->images[i];
    return NULL;
}

/* Of the first pane whose image moved where both have it. */
static DiffKind image_change(const ReviewCase *before, const ReviewCase *after) {
    for (int i = 0; i < after->image_count; i++) {
        const CaseImage *a = &after->images[i], *b = image_like(before, a);
        if (b && a->contrast_high < b->contrast_low) return DIFF_BETTER;
        if (b && a->contrast_low > b->contrast_high) return DIFF_WORSE;
    }
    return DIFF_SAME;
}

/* Of the first age whose level moved where both have it: its interval is the light's. */
static DiffKind level_change(const ReviewCase *before, const ReviewCase *after) {
    for (int i = 0; i < after->visibility_count; i++) {
        const CaseVisibility *a = &after->visibilities[i], *b = level_like(before, a);
        if (b && a->high < b->low) return DIFF_WORSE;
        if (b && a->low > b->high) return DIFF_BETTER;
    }
    return DIFF_SAME;
}

static DiffKind case_change(const ReviewCase *before, const ReviewCase *after) {
    if (!after) return DIFF_GONE;
    if (!before) return DIFF_NEW;
    DiffKind kind = verdict_change(before->verdict, after->verdict);
    if (kind == DIFF_SAME) kind = contrast_change(before, after);
    if (kind == DIFF_SAME) kind = image_change(before, after);
    return kind == DIFF_SAME ? level_change(before, after) : kind;
}

static DiffKind sweep_change(const ReviewSweep *before, const ReviewSweep *after) {
    if (!after) return DIFF_GONE;
    if (!before) return DIFF_NEW;
    DiffKind kind = verdict_change(sweep_verdict(before), sweep_verdict(after));
    double more = after->failed_share - before->failed_share;
    if (kind != DIFF_SAME) return kind;
    return more > LEAST_SHARE ? DIFF_WORSE : more < -LEAST_SHARE ? DIFF_BETTER : DIFF_SAME;
}

static DiffKind gaze_change(const GazeFinding *before, const GazeFinding *after) {
    if (!after) return DIFF_GONE;
    if (!before) return DIFF_NEW;
    if (after->contrast_range.high < before->contrast_range.low) return DIFF_WORSE;
    return after->contrast_range.low > before->contrast_range.high ? DIFF_BETTER : DIFF_SAME;
}

/* ---- what belongs together -------------------------------------------------------------- */

static const ReviewCase *find_case(const Review *review, const ReviewCase *like) {
    return review_case_named(review, like->condition, like->eye, like->symbol);
}

static const ReviewSweep *find_sweep(const Review *review, const ReviewSweep *like) {
    return review_sweep_named(review, like->condition, like->eye, like->symbol);
}

static const GazeFinding *find_gaze(const Review *review, const GazeFinding *like) {
    for (int i = 0; i < review->gaze_count; i++) {
        const GazeFinding *g = &review->gazes[i];
        if (words_same(g->condition, like->condition) && words_same(g->eye, like->eye) &&
            words_same(g->gaze, like->gaze))
            return g;
    }
    return NULL;
}

static void add_case(ReviewDiff *diff, const ReviewCase *before, const ReviewCase *after) {
    DiffKind kind = case_change(before, after);
    diff->cases[diff->case_count++] = (CaseDiff){kind, before, after};
    diff->count[kind]++;
}

static void add_sweep(ReviewDiff *diff, const ReviewSweep *before, const ReviewSweep *after) {
    DiffKind kind = sweep_change(before, after);
    diff->sweeps[diff->sweep_count++] = (SweepDiff){kind, before, after};
    diff->count[kind]++;
}

static void add_gaze(ReviewDiff *diff, const GazeFinding *before, const GazeFinding *after) {
    DiffKind kind = gaze_change(before, after);
    diff->gazes[diff->gaze_count++] = (GazeDiff){kind, before, after};
    diff->count[kind]++;
}

static void pair_cases(ReviewDiff *diff, const Review *before, const Review *after) {
    for (int i = 0; i < after->case_count; i++)
        add_case(diff, find_case(before, &after->cases[i]), &after->cases[i]);
    for (int i = 0; i < before->case_count; i++)
        if (!find_case(after, &before->cases[i])) add_case(diff, &before->cases[i], NULL);
}

static void pair_sweeps(ReviewDiff *diff, const Review *before, const Review *after) {
    for (int i = 0; i < after->sweep_count; i++)
        add_sweep(diff, find_sweep(before, &after->sweeps[i]), &after->sweeps[i]);
    for (int i = 0; i < before->sweep_count; i++)
        if (!find_sweep(after, &before->sweeps[i])) add_sweep(diff, &before->sweeps[i], NULL);
}

static void pair_gazes(ReviewDiff *diff, const Review *before, const Review *after) {
    for (int i = 0; i < after->gaze_count; i++)
        add_gaze(diff, find_gaze(before, &after->gazes[i]), &after->gazes[i]);
    for (int i = 0; i < before->gaze_count; i++)
        if (!find_gaze(after, &before->gazes[i])) add_gaze(diff, &before->gazes[i], NULL);
}

/* By kind; within one as they came: an insertion sort keeps that. */
static void sort_cases(CaseDiff *list, int count) {
    for (int i = 1; i < count; i++) {
        CaseDiff moved = list[i];
        int at = i;
        for (; at > 0 && list[at - 1].kind > moved.kind; at--) list[at] = list[at - 1];
        list[at] = moved;
    }
}

ReviewDiff review_diff(const Review *before, const Review *after, const char *before_name,
                       const char *after_name, Arena *arena) {
    ReviewDiff diff = {
        .before_name = before_name, .after_name = after_name, .before = before, .after = after};
    diff.cases = ARENA_NEW(arena, CaseDiff, before->case_count + after->case_count);
    diff.sweeps = ARENA_NEW(arena, SweepDiff, before->sweep_count + after->sweep_count);
    diff.gazes = ARENA_NEW(arena, GazeDiff, before->gaze_count + after->gaze_count);
    pair_cases(&diff, before, after);
    pair_sweeps(&diff, before, after);
    pair_gazes(&diff, before, after);
    sort_cases(diff.cases, diff.case_count);
    return diff;
}

/* ---- as JSON ---------------------------------------------------------------------------- */

static json_t *two(double before, double after) {
    return json_pack("[o,o]", json_figure(before), json_figure(after));
}

/* Both sides' figure; null where a side has no case. */
static json_t *figures(const CaseDiff *d, size_t offset) {
    double value[2] = {NAN, NAN};
    if (d->before) value[0] = *(const double *)((const char *)d->before + offset);
    if (d->after) value[1] = *(const double *)((const char *)d->after + offset);
    return two(value[0], value[1]);
}

static json_t *interval(const ReviewCase *c) {
    return c ? two(c->contrast_low, c->contrast_high) : json_null();
}

/* kind: "symbol" or "gaze", whose name is `what`. */
static json_t *names_json(const char *condition, const char *eye, const char *kind,
                          const char *what, DiffKind change) {
    return json_pack("{s:o, s:o, s:o, s:s}", "condition", json_text(condition ? condition : ""),
                     "eye", json_text(eye ? eye : ""), kind, json_text(what ? what : ""), "change",
                     diff_names[change]);
}

/* Of each age of either side both levels; NULL: neither has any. */
static json_t *levels_json(const CaseDiff *d) {
    const ReviewCase *either = d->after && d->after->visibility_count ? d->after : d->before;
    if (!either || !either->visibility_count) return NULL;
    json_t *list = json_array();
    for (int i = 0; i < either->visibility_count; i++) {
        const CaseVisibility *v = &either->visibilities[i];
        const CaseVisibility *b = level_like(d->before, v), *a = level_like(d->after, v);
        json_array_append_new(list, json_pack("{s:f, s:f, s:o}", "age_years", v->age_years,
                                              "glance_s", v->glance_s, "level",
                                              two(b ? b->level : NAN, a ? a->level : NAN)));
    }
    return list;
}

static json_t *case_json(const CaseDiff *d) {
    const ReviewCase *either = d->after ? d->after : d->before;
    json_t *out = names_json(either->condition, either->eye, "symbol", either->symbol, d->kind);
    json_object_set_new(out, "verdict",
                        json_pack("[s?, s?]", d->before ? verdict_names[d->before->verdict] : NULL,
                                  d->after ? verdict_names[d->after->verdict] : NULL));
    json_object_set_new(out, "contrast_ratio", figures(d, offsetof(ReviewCase, contrast_ratio)));
    json_object_set_new(out, "contrast_interval",
                        json_pack("[o,o]", interval(d->before), interval(d->after)));
    json_object_set_new(out, "margin", figures(d, offsetof(ReviewCase, margin)));
    json_t *levels = levels_json(d);
    if (levels) json_object_set_new(out, "visibility_levels", levels);
    return out;
}

static json_t *sweep_json(const SweepDiff *d) {
    const ReviewSweep *b = d->before, *a = d->after, *either = a ? a : b;
    json_t *out = names_json(either->condition, either->eye, "symbol", either->symbol, d->kind);
    json_object_set_new(out, "failed_share",
                        two(b ? b->failed_share : NAN, a ? a->failed_share : NAN));
    json_object_set_new(
        out, "longest_failure_minutes",
        two(b ? b->longest_failure_minutes : NAN, a ? a->longest_failure_minutes : NAN));
    return out;
}

static json_t *gaze_json(const GazeDiff *d) {
    const GazeFinding *either = d->after ? d->after : d->before;
    const GazeFinding *b = d->before ? d->before : &diff_no_gaze;
    const GazeFinding *a = d->after ? d->after : &diff_no_gaze;
    json_t *out = names_json(either->condition, either->eye, "gaze", either->gaze, d->kind);
    json_object_set_new(out, "contrast_left", two(b->contrast_left, a->contrast_left));
    json_object_set_new(out, "mirrored_cd_m2", two(b->mirrored, a->mirrored));
    json_object_set_new(out, "veil_cd_m2", two(b->veil, a->veil));
    return out;
}

static json_t *counts_json(const ReviewDiff *diff) {
    json_t *out = json_object();
    for (int kind = 0; kind <= DIFF_SAME; kind++)
        json_object_set_new(out, diff_names[kind], json_integer(diff->count[kind]));
    return out;
}

json_t *review_diff_json(const ReviewDiff *diff) {
    json_t *cases = json_array(), *sweeps = json_array(), *gazes = json_array();
    for (int i = 0; i < diff->case_count; i++)
        json_array_append_new(cases, case_json(&diff->cases[i]));
    for (int i = 0; i < diff->sweep_count; i++)
        json_array_append_new(sweeps, sweep_json(&diff->sweeps[i]));
    for (int i = 0; i < diff->gaze_count; i++)
        json_array_append_new(gazes, gaze_json(&diff->gazes[i]));
    return json_pack("{s:o, s:o, s:[b,b], s:o, s:o, s:o, s:o}", "before",
                     json_text(diff->before_name), "after", json_text(diff->after_name), "pass",
                     diff->before->pass, diff->after->pass, "count", counts_json(diff), "cases",
                     cases, "sweeps", sweeps, "gazes", gazes);
}
