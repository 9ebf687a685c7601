/* SPDX-License-Identifier: Apache-2.0 */
#include "review/finding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "review/judge.h"
#include "review/pane_verdict.h"

static const LimitVerdict *limits_worst(const LimitVerdict *limits, int count) {
    const LimitVerdict *worst = NULL;
    for (int i = 0; i < count; i++)
        if (limit_counts(&limits[i]) && (!worst || limit_is_worse(&limits[i], worst)))
            worst = &limits[i];
    return worst;
}

const LimitVerdict *case_worst_limit(const ReviewCase *c) {
    const LimitVerdict *worst = NULL;
    bool has_contrast = c->limit_id >= 0 && c->limit_id < c->limit_count;
    if (c->verdict == VERDICT_PASS && has_contrast) return &c->limits[c->limit_id];
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        if (limit_counts(limit) && limit->verdict == c->verdict &&
            (!worst || limit_is_worse(limit, worst)))
            worst = limit;
    }
    return worst || !has_contrast ? worst : &c->limits[c->limit_id];
}

const ReviewSweep *review_sweep_of(const Review *review, const ReviewCase *c) {
    for (int i = 0; i < review->sweep_count; i++)
        if (c == &review->sweeps[i].worst) return &review->sweeps[i];
    return NULL;
}

const ReviewCase *review_case_at(const Review *review, int i) {
    int sweep = i - review->case_count;
    return sweep < 0 ? &review->cases[i] : &review->sweeps[sweep].worst;
}

int review_case_count(const Review *review) {
    return review->case_count + review->sweep_count;
}

/* ---- the rows ---------------------------------------------------------------------------- */

static Finding finding_of_case(const Review *review, const ReviewCase *c) {
    return (Finding){.condition = c->condition,
                     .viewer = c->eye,
                     .subject = c->symbol,
                     .verdict = c->verdict,
                     .why = c->unjudged,
                     .counts = review_case_counts(c),
                     .limits = c->limits,
                     .limit_count = c->limit_count,
                     .worst = case_worst_limit(c),
                     .c = c,
                     .sweep = review_sweep_of(review, c)};
}

static void add(Findings *to, Finding f) {
    if (!f.worst) f.worst = limits_worst(f.limits, f.limit_count);
    f.counts |= f.worst != NULL;
    if (f.counts || f.c) to->list[to->count++] = f;
}

Findings review_findings(const Review *review, Arena *arena) {
    int most = review_case_count(review) + review->gaze_count + review->pane_image_count +
               review->false_sun_count;
    Findings out = {ARENA_NEW(arena, Finding, most), 0};
    for (int i = 0; i < review_case_count(review); i++)
        out.list[out.count++] = finding_of_case(review, review_case_at(review, i));
    for (int i = 0; i < review->gaze_count; i++) {
        const GazeFinding *g = &review->gazes[i];
        add(&out, (Finding){.condition = g->condition,
                            .viewer = g->eye,
                            .subject = g->gaze,
                            .verdict = g->verdict,
                            .why = g->unjudged,
                            .limits = g->limits,
                            .limit_count = g->limit_count,
                            .gaze = g});
    }
    for (int i = 0; i < review->pane_image_count; i++) {
        const PaneFinding *f = &review->pane_images[i];
        if (f->has_limit && !f->none)
            add(&out, (Finding){.condition = f->condition,
                                .viewer = f->eye,
                                .subject = arena_format(arena, "%s in %s", f->display, f->pane),
                                .verdict = f->limit.verdict,
                                .why = f->limit.verdict == VERDICT_UNJUDGED ? UNJUDGED_FIGURE
                                                                            : UNJUDGED_NOT,
                                .limits = &f->limit,
                                .limit_count = 1,
                                .pane = f});
    }
    for (int i = 0; i < review->false_sun_count; i++) {
        const ReviewFalseSun *s = &review->false_suns[i];
        add(&out, (Finding){.condition = s->condition,
                            .viewer = s->eye,
                            .subject = s->mirror,
                            .verdict = s->verdict,
                            .limits = s->limits,
                            .limit_count = s->limit_count,
                            .sun = s});
    }
    return out;
}

const char *finding_kind(const Finding *f) {
    return f->sweep ? "sweep" : f->c ? "symbol" : f->gaze ? "gaze" : f->pane ? "pane" : "mirror";
}

/* ---- the worst --------------------------------------------------------------------------- */

static int rank_of(const Finding *f) {
    return f->counts ? verdict_rank(f->verdict) : -1;
}

static double margin_of(const Finding *f) {
    return f->worst ? f->worst->margin : f->c ? f->c->margin : (double)NAN;
}

typedef struct Ranked {
    Finding of;
    int place; /* in the review */
} Ranked;

static int compare_ranked(const void *a, const void *b) {
    const Ranked *first = a, *second = b;
    double one = margin_of(&first->of), other = margin_of(&second->of);
    int more = rank_of(&second->of) - rank_of(&first->of);
    if (more) return more;
    if (one < other || isnan(one) != isnan(other)) return one < other || isnan(other) ? -1 : 1;
    return one > other ? 1 : first->place - second->place;
}

Findings review_ranked(const Review *review, Arena *arena) {
    Findings out = review_findings(review, arena);
    Ranked *ranked = ARENA_NEW(arena, Ranked, out.count);
    for (int i = 0; i < out.count; i++) ranked[i] = (Ranked){out.list[i], i};
    if (out.count > 0) qsort(ranked, (size_t)out.count, sizeof *ranked, compare_ranked);
    for (int i = 0; i < out.count; i++) out.list[i] = ranked[i].of;
    return out;
}

/* ---- what belongs together --------------------------------------------------------------- */

static bool is_name(const char *a, const char *b) {
    return !strcmp(a ? a : "", b ? b : "");
}

const Finding *finding_like(const Findings *list, const Finding *like) {
    for (int i = 0; i < list->count; i++) {
        const Finding *f = &list->list[i];
        if (is_name(f->condition, like->condition) && is_name(f->viewer, like->viewer) &&
            is_name(f->subject, like->subject) && !f->c == !like->c && !f->sweep == !like->sweep &&
            !f->gaze == !like->gaze && !f->pane == !like->pane)
            return f;
    }
    return NULL;
}

const LimitVerdict *finding_line_like(const Finding *finding, const LimitVerdict *like) {
    for (int i = 0; i < finding->limit_count; i++) {
        const LimitVerdict *line = &finding->limits[i];
        if (is_name(line->kind, like->kind) && is_name(line->name, like->name) &&
            is_name(line->by_pane, like->by_pane) && line->age_years == like->age_years)
            return line;
    }
    return NULL;
}
