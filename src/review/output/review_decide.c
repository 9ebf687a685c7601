/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_decide.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

Verdict sweep_verdict(const ReviewSweep *sweep)
{
    return sweep->worst.verdict;
}

const ReviewSweep *review_sweep_of(const Review *review, const ReviewCase *c)
{
    for (int i = 0; i < review->sweep_count; i++)
        if (c == &review->sweeps[i].worst) return &review->sweeps[i];
    return NULL;
}

ReviewCounts review_count(const Review *review)
{
    ReviewCounts counts = {.total = review->case_count + review->sweep_count};
    for (int i = 0; i < review->case_count; i++) counts.of[review->cases[i].verdict]++;
    for (int i = 0; i < review->sweep_count; i++)
        counts.of[sweep_verdict(&review->sweeps[i])]++;
    return counts;
}

Verdict review_verdict(const Review *review)
{
    if (!review->pass) return VERDICT_FAIL;
    return review_count(review).of[VERDICT_TOO_CLOSE] ? VERDICT_TOO_CLOSE : VERDICT_PASS;
}

bool review_decide(Review *review)
{
    ReviewCounts counts = review_count(review);
    int allowed = review->is_strict
                      ? counts.of[VERDICT_PASS]
                      : counts.total - counts.of[VERDICT_FAIL];
    bool is_described = !review->is_strict || !review->without_data_count;
    review->pass = allowed == counts.total && is_described;
    return review->pass;
}

/* ---- the worst -------------------------------------------------------------------------- */

/* NaN is behind every margin: nothing was held against the limit. */
static bool is_less(double a, double b)
{
    return a < b || (isnan(b) && !isnan(a));
}

/* Limits that are not counted (advice, what the program does not measure) may have a verdict
 * that is worse than the case's. */
const LimitVerdict *case_worst_limit(const ReviewCase *c)
{
    const LimitVerdict *worst = NULL;
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        if (limit->is_advice || limit->verdict != c->verdict) continue;
        if (!worst || is_less(limit->margin, worst->margin)) worst = limit;
    }
    bool has_contrast = c->limit_id >= 0 && c->limit_id < c->limit_count;
    return worst || !has_contrast ? worst : &c->limits[c->limit_id];
}

static double worst_margin(const ReviewCase *c)
{
    const LimitVerdict *limit = case_worst_limit(c);
    return limit ? limit->margin : c->margin;
}

typedef struct Ranked {
    const ReviewCase *of;
    Verdict           verdict; /* that is counted: a sweep's own */
    int               place;   /* in the review */
} Ranked;

static bool is_worse(const Ranked *a, const Ranked *b)
{
    int more = verdict_rank(a->verdict) - verdict_rank(b->verdict);
    return more > 0 || (more == 0 && is_less(worst_margin(a->of), worst_margin(b->of)));
}

static int compare_ranked(const void *a, const void *b)
{
    const Ranked *first = a, *second = b;
    if (is_worse(first, second)) return -1;
    if (is_worse(second, first)) return 1;
    return first->place - second->place;
}

static Ranked ranked_at(const Review *review, int place)
{
    if (place < review->case_count) {
        const ReviewCase *c = &review->cases[place];
        return (Ranked){c, c->verdict, place};
    }
    const ReviewSweep *sweep = &review->sweeps[place - review->case_count];
    return (Ranked){&sweep->worst, sweep_verdict(sweep), place};
}

const ReviewCase **review_rank(const Review *review, Arena *arena)
{
    int     count = review->case_count + review->sweep_count;
    Ranked *ranked = ARENA_NEW(arena, Ranked, count);
    const ReviewCase **out = ARENA_NEW(arena, const ReviewCase *, count);
    for (int i = 0; i < count; i++) ranked[i] = ranked_at(review, i);
    if (count > 0) qsort(ranked, (size_t)count, sizeof *ranked, compare_ranked);
    for (int i = 0; i < count; i++) out[i] = ranked[i].of;
    return out;
}

const ReviewCase *review_worst(const Review *review, Arena scratch)
{
    int count = review->case_count + review->sweep_count;
    return count > 0 ? review_rank(review, &scratch)[0] : NULL;
}

static bool is_like(const ReviewCase *a, const ReviewCase *b)
{
    return !strcmp(a->condition, b->condition) && !strcmp(a->eye, b->eye) &&
           !strcmp(a->symbol, b->symbol);
}

const ReviewCase *review_case_like(const Review *review, const ReviewCase *like)
{
    for (int i = 0; i < review->case_count; i++)
        if (is_like(&review->cases[i], like)) return &review->cases[i];
    for (int i = 0; i < review->sweep_count; i++)
        if (is_like(&review->sweeps[i].worst, like)) return &review->sweeps[i].worst;
    return NULL;
}

static void add_places(const ReviewCase *c, ReviewPlaces *list, int *count)
{
    int i = 0;
    if (isnan(c->eye_failed_share) || !c->eye || !c->symbol) return;
    while (i < *count && (strcmp(list[i].at->eye, c->eye) != 0 ||
                          strcmp(list[i].at->symbol, c->symbol) != 0))
        i++;
    double share = 1 - c->eye_failed_share;
    if (i == *count) ++*count;
    else if (list[i].read_share <= share) return;
    list[i] = (ReviewPlaces){c, share};
}

ReviewPlaces *review_places(const Review *review, int *count, Arena *arena)
{
    ReviewPlaces *list =
        ARENA_NEW(arena, ReviewPlaces, review->case_count + review->sweep_count + 1);
    *count = 0;
    for (int i = 0; i < review->case_count; i++) add_places(&review->cases[i], list, count);
    for (int i = 0; i < review->sweep_count; i++)
        add_places(&review->sweeps[i].worst, list, count);
    return list;
}
