/* SPDX-License-Identifier: Apache-2.0 */
#include "review/vary/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/confidence.h"
#include "base/mathd.h"
#include "review/judge.h"
#include "review/light/setup.h"
#include "review/request/request_check.h"
#include "review/request/request_parameters.h"
#include "review/review_decide.h"
#include "review/run/rests.h"
#include "review/run/run.h"
#include "scene/load/scene_load.h"

#define JUDGE_BYTES ((size_t)1 << 20)
#define SCENE_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

/* ---- differences ------------------------------------------------------------------------- */

/* The margin that a case would have if it reflected so much. */
static double margin_with(const ReviewCase *of, double reflected, const Profile *profile,
                          Arena scratch)
{
    ReviewCase c = *of;
    c.luminance_cd_m2.reflected = reflected;
    judge_contrasts(&c, (MeanInterval){reflected, reflected});
    judge_case(&c, profile, &scratch);
    return c.margin;
}

/* The jackknife's margin, without one batch; by all where batches are not known. */
static double margin_without(const ReviewCase *of, int batch, const Profile *profile,
                             Arena scratch)
{
    double all = of->luminance_cd_m2.reflected;
    double left = of->batches
                      ? (CASE_BATCHES * all - of->batches[batch]) / (CASE_BATCHES - 1)
                      : all;
    return margin_with(of, left, profile, scratch);
}

/* Half the interval of a margin that an image in glass decides, whose batches are not kept:
 * with the panel's own error, so that a difference is known at least as well; 0: none does. */
static double image_half(const ReviewCase *of)
{
    const LimitVerdict *limit = of->limit_id >= 0 ? &of->limits[of->limit_id] : NULL;
    return limit && limit->by_pane ? 0.5 * (limit->high - limit->low) / limit->value : 0;
}

static void set_difference(const Profile *profile, ReviewDifference *of, Arena scratch)
{
    double each[CASE_BATCHES], mean = 0, squares = 0;
    of->margin = of->after->margin - of->before->margin;
    for (int i = 0; i < CASE_BATCHES; i++) {
        each[i] = margin_without(of->after, i, profile, scratch) -
                  margin_without(of->before, i, profile, scratch);
        mean += each[i] / CASE_BATCHES;
    }
    for (int i = 0; i < CASE_BATCHES; i++) squares += (each[i] - mean) * (each[i] - mean);
    double error = sqrt(squares * (CASE_BATCHES - 1) / CASE_BATCHES);
    double half = student_quantile(CASE_BATCHES - 1) * error;
    double images = hypot_d(image_half(of->before), image_half(of->after));
    if (images > 0) half = hypot_d(half, images);
    of->margin_range = (MeanInterval){of->margin - half, of->margin + half};
}

/* The margin of one case less that of another. */
static ReviewDifference review_difference(const Profile *profile, const ReviewCase *before,
                                          const ReviewCase *after)
{
    ReviewDifference d = {.before = before, .after = after, .margin = (double)NAN,
                          .margin_range = {(double)NAN, (double)NAN}};
    if (!before || !after) return d;
    Arena scratch = arena_reserve(JUDGE_BYTES);
    set_difference(profile, &d, scratch);
    arena_release(&scratch);
    return d;
}

/* The case or sweep's worst with the least margin of contrast; NULL: none has one. */
static const ReviewCase *review_least_margin(const Review *review)
{
    const ReviewCase *least = NULL;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (!isnan(c->margin) && (!least || c->margin < least->margin)) least = c;
    }
    return least;
}

static ReviewDifference sweeps_of(ReviewDifference d, const Review *base, const Review *review)
{
    if (d.before) d.sweep_before = review_sweep_of(base, d.before);
    if (d.after) d.sweep_after = review_sweep_of(review, d.after);
    return d;
}

static void compare(const Profile *profile, const Review *base, ReviewVariantFound *found,
                    Arena *arena)
{
    const Review *review = found->review;
    found->difference_count = review_case_count(review);
    found->differences = ARENA_NEW(arena, ReviewDifference, found->difference_count);
    for (int i = 0; i < found->difference_count; i++) {
        const ReviewCase *after = review_case_at(review, i);
        ReviewDifference  d =
            review_difference(profile, review_case_like(base, after), after);
        found->differences[i] = sweeps_of(d, base, review);
    }
    ReviewDifference worst = review_difference(profile, review_least_margin(base),
                                               review_least_margin(review));
    found->worst = sweeps_of(worst, base, review);
}

/* ---- before all -------------------------------------------------------------------------- */

static bool check_one(const ReviewRun *run, const ReviewVariant *variant, Error *err)
{
    Arena         scratch = arena_reserve(SCENE_BYTES);
    Problems      problems = problems_start(&scratch); /* warnings are the review's own */
    ReviewRequest request = review_request_variant(run->request, variant, &scratch);
    SetupOptions  options = {.request = &request, .means = run->means};
    Scene *scene;
    bool   ok = setup_scene(&options, &scratch, &problems, &scene, err);
    if (ok) {
        ok = review_request_check(&request, scene, &problems) ||
             problems_verdict(&problems, err);
        scene_close(scene);
    }
    arena_release(&scratch);
    return ok || error_prefix(err, "variant '%.100s'", variant->name);
}

bool review_variants_check(const ReviewRun *run, Error *err)
{
    const ReviewRequest *request = run->request;
    for (int i = 0; i < request->variant_count; i++)
        if (!check_one(run, &request->variants[i], err)) return false;
    for (int i = 0; i < request->parameter_count; i++) {
        const ReviewParameter *p = &request->parameters[i];
        Arena         scratch = arena_reserve(JUDGE_BYTES);
        double        value = p->at + p->step <= p->high ? p->at + p->step : p->low;
        ReviewVariant variant = review_parameter_at(request, p, value, &scratch);
        variant.name = p->name;
        bool ok = check_one(run, &variant, err);
        arena_release(&scratch);
        if (!ok) return false;
    }
    return true;
}

/* ---- all of them ------------------------------------------------------------------------- */

static bool run_variant(const ReviewRun *run, const ReviewVariant *variant, const Review *base,
                        Arena *arena, ReviewOutcome *out, Error *err)
{
    ReviewRequest *request = ARENA_NEW(arena, ReviewRequest, 1);
    *request = review_request_variant(run->request, variant, arena);
    ReviewRun own = review_run_of(run, request, base);
    return review_run_conditions(&own, arena, out, err) ||
           (err->code && error_prefix(err, "variant '%.100s'", variant->name));
}

/* A request that is another's but for a change, run for its verdicts, and held against that. */
static bool review_variant(const ReviewRun *run, const ReviewVariant *variant,
                           const Review *base, Arena *arena, ReviewVariantFound *out,
                           Error *err)
{
    ReviewOutcome *outcome = ARENA_NEW(arena, ReviewOutcome, 1);
    if (!run_variant(run, variant, base, arena, outcome, err)) return false;
    *out = (ReviewVariantFound){.name = variant->name, .words = variant->words,
                                .word_count = variant->word_count,
                                .review = &outcome->review};
    out->review->is_strict = base->is_strict;
    review_decide(out->review);
    compare(run->profile, base, out, arena);
    return true;
}

bool review_variants(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err)
{
    const ReviewRequest *request = run->request;
    Review   *review = &outcome->review;
    ReviewVariantFound *list = ARENA_NEW(arena, ReviewVariantFound, request->variant_count);
    for (int i = 0; i < request->variant_count; i++) {
        if (!review_variant(run, &request->variants[i], review, arena, &list[i], err))
            return false;
        rests_add_files_of(list[i].review, review, arena);
    }
    review->variants = list;
    review->variant_count = request->variant_count;
    return true;
}

/* ---- how margins hang on a number -------------------------------------------------------- */

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

/* ---- the smallest change that remedies --------------------------------------------------- */

#define TRIALS_MOST 64
#define FINE 8             /* parts of a step: a narrower gap is none */
#define CONFIRMS 5         /* values that fresh paths are traced for */
#define FRESH_TIMES 2      /* reviews by paths of their own at each */
#define FRESH_SEED 0x20000000u

typedef struct Mending {
    const ReviewRun       *run;
    const ReviewParameter *parameter;
    const Review          *base;
    Arena                 *arena;
    double                 scale;
    ReviewMend             out;
} Mending;

/* ---- one value --------------------------------------------------------------------------- */

static void note(Mending *m, double value, const Review *review, bool is_fresh)
{
    const ReviewCase *least = review_least_margin(review);
    m->out.trials[m->out.trial_count++] =
        (ReviewTrial){m->scale * value, review_verdict(review),
                      least ? least->margin : (double)NAN, is_fresh,
                      least ? words_case(least, m->arena) : NULL};
}

/* Does everything pass there? fresh: by other paths, and no more of them than a review by
 * itself takes; 0: by the review's. */
static bool try_value(Mending *m, double value, int fresh, bool *passes, Error *err)
{
    ReviewVariantFound found;
    ReviewVariant variant =
        review_parameter_at(m->run->request, m->parameter, value, m->arena);
    ReviewRequest request = *m->run->request;
    ReviewRun     run = *m->run;
    request.seed += (uint32_t)fresh * FRESH_SEED;
    request.is_compared = fresh == 0;
    run.request = &request;
    if (!review_variant(&run, &variant, m->base, m->arena, &found, err)) return false;
    note(m, value, found.review, fresh > 0);
    *passes = review_verdict(found.review) == VERDICT_PASS;
    return true;
}

/* ---- the search -------------------------------------------------------------------------- */

/* A side of the search: how far it went without passing. */
typedef struct Side {
    double sign, last, reach; /* values as distances from where the parameter stands */
} Side;

/* Brightness is turned by factors, all else by lengths and angles. */
static double value_at(const ReviewParameter *p, double sign, double distance)
{
    if (p->kind == PARAMETER_BRIGHTNESS) return p->at * pow(1 + distance, sign);
    return p->at + sign * distance;
}

static double reach_of(const ReviewParameter *p, double sign)
{
    if (p->kind == PARAMETER_BRIGHTNESS)
        return (sign > 0 ? p->high / p->at : p->at / p->low) - 1;
    return sign > 0 ? p->high - p->at : p->at - p->low;
}

/* Ever larger steps to both sides; *side: the one that passes, NULL: none does. */
static bool expand(Mending *m, Side sides[2], Side **side, double *found, Error *err)
{
    const ReviewParameter *p = m->parameter;
    *side = NULL;
    for (double step = p->step;; step *= 2) {
        bool any = false;
        for (int i = 0; i < 2; i++) {
            double distance = fmin(step, sides[i].reach);
            bool   passes;
            if (!(distance > sides[i].last)) continue;
            any = true;
            if (!try_value(m, value_at(p, sides[i].sign, distance), 0, &passes, err))
                return false;
            if (!passes) {
                sides[i].last = distance;
                continue;
            }
            *side = &sides[i];
            *found = distance;
            return true;
        }
        if (!any) return true;
    }
}

static bool narrow(Mending *m, Side *side, double *found, Error *err)
{
    while (*found - side->last > fmax(m->parameter->step / FINE, 0.02 * *found)) {
        double middle = 0.5 * (*found + side->last);
        bool   passes;
        if (!try_value(m, value_at(m->parameter, side->sign, middle), 0, &passes, err))
            return false;
        if (passes) *found = middle;
        else side->last = middle;
    }
    return true;
}

static bool is_confirmed(Mending *m, double value, bool *out, Error *err)
{
    *out = true;
    for (int fresh = 1; fresh <= FRESH_TIMES && *out; fresh++)
        if (!try_value(m, value, fresh, out, err)) return false;
    return true;
}

static bool confirm(Mending *m, Side *side, double found, Error *err)
{
    const ReviewParameter *p = m->parameter;
    double gap = fmax(found - side->last, p->step / FINE);
    for (int i = 0; i < CONFIRMS && !m->out.is_found; i++) {
        double distance = fmin(found + i * gap, side->reach);
        double value = value_at(p, side->sign, distance);
        m->out.value = m->scale * value;
        if (!is_confirmed(m, value, &m->out.is_found, err)) return false;
        if (!m->out.is_found) side->last = distance;
    }
    m->out.outside = m->scale * value_at(p, side->sign, side->last);
    return true;
}

/* Takes the trial whose least margin is greatest. */
static void take_nearest(Mending *m)
{
    double best = -(double)INFINITY;
    for (int i = 0; i < m->out.trial_count; i++) {
        const ReviewTrial *trial = &m->out.trials[i];
        if (!(trial->margin > best)) continue;
        best = trial->margin;
        m->out.value = trial->value;
    }
}

/* A panel that is not usable, light via things without data: no value makes that judged. */
static bool is_beyond_mending(const Review *review)
{
    for (int i = 0; i < review_case_count(review); i++) {
        Unjudged why = review_case_at(review, i)->unjudged;
        if (why == UNJUDGED_PANEL || why == UNJUDGED_DATA) return true;
    }
    return false;
}

static bool search(Mending *m, Error *err)
{
    const ReviewParameter *p = m->parameter;
    Side   sides[2] = {{1, 0, reach_of(p, 1)}, {-1, 0, reach_of(p, -1)}};
    Side  *side;
    double found = 0;
    note(m, p->at, m->base, false);
    m->out.value = m->out.at;
    m->out.outside = (double)NAN;
    m->out.is_found = review_verdict(m->base) == VERDICT_PASS;
    if (m->out.is_found || is_beyond_mending(m->base)) return true;
    if (!expand(m, sides, &side, &found, err)) return false;
    if (side) return narrow(m, side, &found, err) && confirm(m, side, found, err);
    take_nearest(m);
    m->out.outside = m->out.value;
    return true;
}

bool review_mend(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err)
{
    const ReviewParameter *parameter = run->mend;
    Review *review = &outcome->review;
    Mending m = {.run = run, .parameter = parameter, .base = review, .arena = arena};
    m.out = (ReviewMend){.name = parameter->name,
                         .unit = review_parameter_unit(parameter, &m.scale),
                         .trials = ARENA_NEW(arena, ReviewTrial, TRIALS_MOST)};
    m.out.at = m.scale * parameter->at;
    if (!search(&m, err)) return false;
    ReviewMend *list = ARENA_NEW(arena, ReviewMend, review->mend_count + 1);
    for (int i = 0; i < review->mend_count; i++) list[i] = review->mends[i];
    list[review->mend_count++] = m.out;
    review->mends = list;
    return true;
}
