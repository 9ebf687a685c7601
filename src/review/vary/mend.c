/* SPDX-License-Identifier: Apache-2.0 */
#include "review/vary/mend.h"

#include <math.h>

#include "base/mathd.h"
#include "review/pace/work.h"
#include "review/review_names.h"
#include "review/request/request_parameters.h"
#include "review/review_decide.h"
#include "review/vary/variants.h"

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
    WorkPlan               trial;  /* what one takes */
    int                    to_come; /* of them, as they are planned */
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

/* How many more trials are thought of, now. */
static void expect(Mending *m, int trials)
{
    WorkPlan before = {{0}}, now = {{0}};
    work_plan_add(&before, &m->trial, m->to_come);
    work_plan_add(&now, &m->trial, trials);
    work_replan(m->run->work, &before, &now);
    m->to_come = trials;
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
    run.rider_count = 0;
    if (m->to_come < 1) expect(m, 1);
    if (!review_variant(&run, &variant, m->base, m->arena, &found, err)) return false;
    m->to_come--;
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
        double gap = fmax(m->parameter->step / FINE, 0.02 * *found);
        expect(m, (int)ceil(log2_d((*found - side->last) / gap)) + FRESH_TIMES);
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
    expect(m, FRESH_TIMES);
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
    Mending m = {.run = run, .parameter = parameter, .base = review, .arena = arena,
                 .trial = work_of_trial(run->request, parameter), .to_come = WORK_TRIALS};
    m.out = (ReviewMend){.name = parameter->name,
                         .unit = review_parameter_unit(parameter, &m.scale),
                         .trials = ARENA_NEW(arena, ReviewTrial, TRIALS_MOST)};
    m.out.at = m.scale * parameter->at;
    if (!search(&m, err)) return false;
    expect(&m, 0);
    ReviewMend *list = ARENA_NEW(arena, ReviewMend, review->mend_count + 1);
    for (int i = 0; i < review->mend_count; i++) list[i] = review->mends[i];
    list[review->mend_count++] = m.out;
    review->mends = list;
    return true;
}
