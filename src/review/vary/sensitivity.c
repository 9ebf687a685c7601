/* SPDX-License-Identifier: Apache-2.0 */
#include "review/vary/sensitivity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "review/request/request_parameters.h"
#include "review/review_decide.h"
#include "review/vary/variants.h"

/* ---- the least margin of each symbol ----------------------------------------------------- */

/* Its place among the slopes; a new one where there is none. */
static ReviewSlope *slope_of(ReviewSensitivity *to, const char *symbol)
{
    for (int i = 0; i < to->slope_count; i++)
        if (!strcmp(to->slopes[i].of->symbol, symbol)) return &to->slopes[i];
    return &to->slopes[to->slope_count++];
}

static int compare_margin(const void *a, const void *b)
{
    const ReviewSlope *one = a, *other = b;
    double x = one->of->margin, y = other->of->margin;
    return x != y ? (x < y ? -1 : 1) : strcmp(one->of->symbol, other->of->symbol);
}

static void list_symbols(const Review *review, ReviewSensitivity *to, Arena *arena)
{
    int count = review_case_count(review);
    to->slopes = ARENA_NEW(arena, ReviewSlope, count);
    for (int i = 0; i < count; i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (isnan(c->margin)) continue;
        ReviewSlope *slope = slope_of(to, c->symbol);
        if (!slope->of || c->margin < slope->of->margin) slope->of = c;
    }
    if (to->slope_count > 0)
        qsort(to->slopes, (size_t)to->slope_count, sizeof *to->slopes, compare_margin);
}

/* ---- one parameter ----------------------------------------------------------------------- */

/* The review with the parameter at `value`. At the present value it is `base`, but for a
 * coating, which its own layers define. NULL: it failed. */
static const Review *review_at(const ReviewRun *run, const ReviewParameter *p, double value,
                               const Review *base, Arena *arena, Error *err)
{
    ReviewVariantFound found;
    if (value == p->at && p->kind != PARAMETER_REFLECTANCE) return base;
    ReviewVariant variant = review_parameter_at(run->request, p, value, arena);
    return review_variant(run, &variant, base, arena, &found, err) ? found.review : NULL;
}

static void set_slope(const Profile *profile, const Review *below, const Review *above,
                      double distance, ReviewSlope *to)
{
    ReviewDifference d = review_difference(profile, review_case_like(below, to->of),
                                           review_case_like(above, to->of));
    to->slope = d.margin / distance;
    to->range = (MeanInterval){d.margin_range.low / distance, d.margin_range.high / distance};
}

static bool find_slopes(const ReviewRun *run, const ReviewParameter *p, const Review *base,
                        Arena *arena, ReviewSensitivity *out, Error *err)
{
    double scale, ends[2];
    review_parameter_ends(p, ends);
    double low = ends[0], high = ends[1];
    *out = (ReviewSensitivity){.name = p->name, .unit = review_parameter_unit(p, &scale)};
    out->at = scale * p->at;
    out->step = scale * p->step;
    out->low = scale * low;
    out->high = scale * high;
    list_symbols(base, out, arena);
    const Review *below = review_at(run, p, low, base, arena, err);
    const Review *above = below ? review_at(run, p, high, base, arena, err) : NULL;
    if (!above) return false;
    for (int i = 0; i < out->slope_count; i++)
        set_slope(run->profile, below, above, scale * (high - low), &out->slopes[i]);
    return true;
}

bool review_sensitivities(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena,
                          Error *err)
{
    const ReviewRequest *request = run->request;
    Review   *review = &outcome->review;
    ReviewSensitivity *list = ARENA_NEW(arena, ReviewSensitivity, request->parameter_count);
    for (int i = 0; i < request->parameter_count; i++) {
        if (!find_slopes(run, &request->parameters[i], review, arena, &list[i], err))
            return false;
    }
    review->sensitivities = list;
    review->sensitivity_count = request->parameter_count;
    return true;
}
