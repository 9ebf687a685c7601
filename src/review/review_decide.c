/* SPDX-License-Identifier: Apache-2.0 */
#include "review/review_decide.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"
#include "print/utf8.h"
#include "review/pane_verdict.h"
#include "review/quantity.h"
#include "review/road_verdict.h"

Verdict sweep_verdict(const ReviewSweep *sweep) {
    return sweep->worst.verdict;
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

ReviewCounts review_count(const Review *review) {
    ReviewCounts counts = {.total = review_case_count(review)};
    for (int i = 0; i < counts.total; i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (review_case_counts(c)) counts.of[c->verdict]++;
        else counts.not_asked++;
    }
    for (int i = 0; i < review->gaze_count; i++) {
        if (!gaze_counts(&review->gazes[i])) continue;
        counts.of[review->gazes[i].road->verdict]++;
        counts.total++;
    }
    for (int i = 0; i < review->pane_image_count; i++) {
        if (!pane_counts(&review->pane_images[i])) continue;
        counts.of[review->pane_images[i].limit.verdict]++;
        counts.total++;
    }
    return counts;
}

/* Of cases of which none counts: does each require something that need not be seen, or nothing?
 * Where no limit applies nothing is known of it. */
static bool has_optional(const Review *review) {
    for (int i = 0; i < review_case_count(review); i++)
        if (review_case_at(review, i)->unjudged == UNJUDGED_HIDDEN) return true;
    return false;
}

/* The worst of all that count. */
static Verdict found_verdict(const Review *review) {
    static const Verdict ORDER[] = {VERDICT_FAIL, VERDICT_UNJUDGED, VERDICT_TOO_CLOSE};
    ReviewCounts counts = review_count(review);
    for (int i = 0; i < COUNT_OF(ORDER); i++)
        if (counts.of[ORDER[i]]) return ORDER[i];
    bool is_nothing = counts.total > 0 && counts.not_asked == counts.total;
    return is_nothing && !has_optional(review) ? VERDICT_UNJUDGED : VERDICT_PASS;
}

Verdict review_verdict(const Review *review) {
    Verdict found = found_verdict(review);
    return review->pass || found == VERDICT_UNJUDGED ? found : VERDICT_FAIL;
}

bool review_decide(Review *review) {
    Verdict found = found_verdict(review);
    bool is_clear = found == VERDICT_PASS && !review->without_data_count;
    review->pass =
        review->is_strict ? is_clear : found == VERDICT_PASS || found == VERDICT_TOO_CLOSE;
    return review->pass;
}

/* ---- the worst -------------------------------------------------------------------------- */

/* NaN is behind every margin: nothing was held against the limit. */
static bool is_less(double a, double b) {
    return a < b || (isnan(b) && !isnan(a));
}

/* Advice, and what is not measured, or of a shape without strokes cannot be. */
static bool is_listed_only(const LimitVerdict *limit) {
    LimitKind kind = limit_kind_named(limit->kind);
    bool may_be_missing = kind == LIMIT_STROKE_RATIO || kind == LIMIT_WIDTH_RATIO;
    return limit->is_advice || (may_be_missing && isnan(limit->found));
}

const LimitVerdict *case_worst_limit(const ReviewCase *c) {
    const LimitVerdict *worst = NULL;
    bool has_contrast = c->limit_id >= 0 && c->limit_id < c->limit_count;
    if (c->verdict == VERDICT_PASS && has_contrast) return &c->limits[c->limit_id];
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        if (is_listed_only(limit) || limit->verdict != c->verdict) continue;
        if (!worst || is_less(limit->margin, worst->margin)) worst = limit;
    }
    return worst || !has_contrast ? worst : &c->limits[c->limit_id];
}

static double worst_margin(const ReviewCase *c) {
    const LimitVerdict *limit = case_worst_limit(c);
    return limit ? limit->margin : c->margin;
}

typedef struct Ranked {
    const ReviewCase *of;
    int place; /* in the review */
} Ranked;

static int rank_of(const ReviewCase *c) {
    return review_case_counts(c) ? verdict_rank(c->verdict) : -1;
}

static bool is_worse(const ReviewCase *a, const ReviewCase *b) {
    int more = rank_of(a) - rank_of(b);
    return more > 0 || (more == 0 && is_less(worst_margin(a), worst_margin(b)));
}

static int compare_ranked(const void *a, const void *b) {
    const Ranked *first = a, *second = b;
    if (is_worse(first->of, second->of)) return -1;
    if (is_worse(second->of, first->of)) return 1;
    return first->place - second->place;
}

const ReviewCase **review_rank(const Review *review, Arena *arena) {
    int count = review_case_count(review);
    Ranked *ranked = ARENA_NEW(arena, Ranked, count);
    const ReviewCase **out = ARENA_NEW(arena, const ReviewCase *, count);
    for (int i = 0; i < count; i++) ranked[i] = (Ranked){review_case_at(review, i), i};
    if (count > 0) qsort(ranked, (size_t)count, sizeof *ranked, compare_ranked);
    for (int i = 0; i < count; i++) out[i] = ranked[i].of;
    return out;
}

static bool is_worse_gaze(const GazeFinding *a, const GazeFinding *b) {
    int more = verdict_rank(a->road->verdict) - verdict_rank(b->road->verdict);
    return more > 0 ||
           (more == 0 && is_less(gaze_worst_age(a)->limit.margin, gaze_worst_age(b)->limit.margin));
}

const GazeFinding *review_worst_road(const Review *review) {
    const GazeFinding *worst = NULL;
    for (int i = 0; i < review->gaze_count; i++) {
        const GazeFinding *g = &review->gazes[i];
        if (gaze_counts(g) && (!worst || is_worse_gaze(g, worst))) worst = g;
    }
    return worst;
}

const ReviewCase *review_worst(const Review *review, Arena scratch) {
    return review_case_count(review) > 0 ? review_rank(review, &scratch)[0] : NULL;
}

/* ---- by names --------------------------------------------------------------------------- */

static bool is_name(const char *a, const char *b) {
    return !strcmp(a ? a : "", b ? b : "");
}

const ReviewCase *review_case_named(const Review *review, const char *condition, const char *eye,
                                    const char *symbol) {
    for (int i = 0; i < review->case_count; i++) {
        const ReviewCase *c = &review->cases[i];
        if (is_name(c->condition, condition) && is_name(c->eye, eye) && is_name(c->symbol, symbol))
            return c;
    }
    return NULL;
}

const ReviewSweep *review_sweep_named(const Review *review, const char *condition, const char *eye,
                                      const char *symbol) {
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *s = &review->sweeps[i];
        if (is_name(s->condition, condition) && is_name(s->eye, eye) && is_name(s->symbol, symbol))
            return s;
    }
    return NULL;
}

const ReviewCase **review_displays(const Review *review, int *count, Arena *arena) {
    int all = review_case_count(review);
    const ReviewCase **list = ARENA_NEW(arena, const ReviewCase *, all);
    *count = 0;
    for (int i = 0; i < all; i++) {
        const ReviewCase *c = review_case_at(review, i);
        int k = 0;
        while (k < *count && !is_name(list[k]->display, c->display)) k++;
        if (k == *count) list[(*count)++] = c;
    }
    return list;
}

const ReviewCase *review_case_like(const Review *review, const ReviewCase *like) {
    const ReviewCase *c = review_case_named(review, like->condition, like->eye, like->symbol);
    if (c) return c;
    const ReviewSweep *s = review_sweep_named(review, like->condition, like->eye, like->symbol);
    return s ? &s->worst : NULL;
}

bool review_has_privacy(const Review *review) {
    for (int i = 0; i < review_case_count(review); i++)
        if (review_case_at(review, i)->must_not_be_read) return true;
    return false;
}

static void add_places(const ReviewCase *c, ReviewPlaces *list, int *count) {
    int i = 0;
    if (isnan(c->eye_failed_share) || !c->eye || !c->symbol) return;
    while (i < *count &&
           (strcmp(list[i].at->eye, c->eye) != 0 || strcmp(list[i].at->symbol, c->symbol) != 0))
        i++;
    double share = 1 - c->eye_failed_share;
    if (i == *count) ++*count;
    else if (list[i].passing_share <= share) return;
    list[i] = (ReviewPlaces){c, share};
}

ReviewPlaces *review_places(const Review *review, int *count, Arena *arena) {
    int all = review_case_count(review);
    ReviewPlaces *list = ARENA_NEW(arena, ReviewPlaces, all + 1);
    *count = 0;
    for (int i = 0; i < all; i++) add_places(review_case_at(review, i), list, count);
    return list;
}

/* ---- names ------------------------------------------------------------------------------- */

const char *words_case(const ReviewCase *c, Arena *arena) {
    return arena_format(arena, "%s, seen by %s, %s", c->symbol ? c->symbol : "?",
                        c->eye ? c->eye : "?", c->condition ? c->condition : "?");
}

const char *words_file_name(const char *text, Arena *arena) {
    char *name = ARENA_NEW(arena, char, WORDS_FILE_NAME_MOST + 1);
    for (int length = 0; *text && length < WORDS_FILE_NAME_MOST; text++) {
        bool is_plain = (*text >= 'a' && *text <= 'z') || (*text >= 'A' && *text <= 'Z') ||
                        (*text >= '0' && *text <= '9') || *text == '_';
        if (!utf8_continues(*text)) name[length++] = is_plain ? *text : '-';
    }
    return name;
}
