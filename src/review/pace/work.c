/* SPDX-License-Identifier: Apache-2.0 */
#include "review/pace/work.h"

#include <math.h>

#include "base/mathd.h"

#define FOUND_LIKELY 6      /* symbols of a rectangle in which text is found */
#define CASE 0.28           /* of an eye's point, with its causes */
#define CASE_BARE 0.15
#define CASE_COMPARED 0.1   /* more, of a review with variants */
#define POINT 0.015         /* of each further point of an eye's box */
#define FRAME 42.0          /* of a frame, however small, */
#define FRAME_PIXEL 6e-5    /* and its pixels, at the usual noise */
#define FRAME_PAIR 0.3      /* of it, of a variant's */
#define FRAME_LAYERS 0.17   /* of it, of what a reader may move on the page */
#define FRAME_NOISE 0.15    /* reached by about as many samples as any frame has */
#define MINUTES_A_YEAR (365 * 24 * 60.0)
#define RESPONSE_PATHS 65536 /* of most responses */
#define SUN 1.7e-5
#define WORST 1.2            /* read again, with its causes; */
#define WORST_BARE 0.9       /* without */
#define PRIOR_S 5            /* of all work: as much as is thought of it */
#define PRIOR_KIND 0.2       /* of a kind: as much as of all others */
#define RECENT_S 30          /* by which others' load is judged: older time fades */
#define RECENT_PRIOR_S 1
#define OWN_LEAST 0.02       /* of the time, however much of it was waiting */
#define UNTIMED 0.05         /* of its weight's time: less was done before */

static const double WEIGHT[WORK_KINDS] = {
    [WORK_OPEN] = 0.5,  [WORK_LEARN] = 1.5, [WORK_LOOK] = 1.25,      [WORK_RESPONSE] = 3.2,
    [WORK_METER] = 0.1, [WORK_OWN] = 0.1,   [WORK_FALSE_SUNS] = 3.5, [WORK_SKIES] = 0.5};

double work_of(WorkKind kind)
{
    return WEIGHT[kind];
}

void work_plan_add(WorkPlan *to, const WorkPlan *of, double times)
{
    for (int k = 0; k < WORK_KINDS; k++) to->of[k] += times * of->of[k];
}

static double sum_of(const WorkPlan *plan)
{
    double sum = 0;
    for (int k = 0; k < WORK_KINDS; k++) sum += plan->of[k];
    return sum;
}

/* ---- what there is to do ----------------------------------------------------------------- */

double work_of_case(const ReviewRequest *request, const ReviewEye *eye, bool is_bare)
{
    double more = request->is_compared ? CASE_COMPARED : 0;
    return (is_bare ? CASE_BARE : CASE) + more + POINT * (review_eye_count(eye) - 1);
}

double work_of_sight(int suns, bool is_bare)
{
    return SUN * suns + (is_bare ? WORST_BARE : WORST);
}

double work_of_response(int paths)
{
    return WEIGHT[WORK_RESPONSE] * paths / RESPONSE_PATHS;
}

static int symbols_of(const ReviewRequest *request)
{
    int count = 0;
    for (int i = 0; i < request->symbol_count; i++)
        count += request->symbols[i].find_text ? FOUND_LIKELY : 1;
    return count;
}

/* A variant has the guides of its review, unless it is mirrored. */
static bool learns(const ReviewRequest *request, bool is_bare)
{
    return !is_bare || (request->change && request->change->mirror);
}

WorkPlan work_of_moment(const ReviewRequest *request, int symbols, bool is_bare)
{
    WorkPlan plan = {{[WORK_OPEN] = WEIGHT[WORK_OPEN]}};
    plan.of[WORK_LEARN] = learns(request, is_bare) ? WEIGHT[WORK_LEARN] : 0;
    for (int e = 0; e < request->eye_count; e++)
        plan.of[is_bare ? WORK_BARE_CASE : WORK_CASE] +=
            symbols * work_of_case(request, &request->eyes[e], is_bare);
    if (!is_bare) plan.of[WORK_LOOK] = WEIGHT[WORK_LOOK] * review_look_count(request);
    return plan;
}

/* About: of a year half are up. */
static double suns_of(const ReviewCondition *c)
{
    if (c->kind == CONDITION_SUN_SWEEP)
        return (double)c->azimuth_deg.count * c->elevation_deg.count;
    return 0.5 * MINUTES_A_YEAR / c->step_minutes * c->heading_count;
}

static WorkPlan work_of_sweep(const ReviewRequest *request, const ReviewCondition *condition,
                              bool is_bare)
{
    int      symbols = symbols_of(request), sights = request->eye_count * symbols;
    WorkPlan plan = {{[WORK_OPEN] = WEIGHT[WORK_OPEN], [WORK_SKIES] = WEIGHT[WORK_SKIES]}};
    plan.of[WORK_RESPONSE] = sights * WEIGHT[WORK_RESPONSE];
    plan.of[WORK_METER] = symbols * WEIGHT[WORK_METER];
    plan.of[WORK_OWN] = (sights + symbols) * 2 * WEIGHT[WORK_OWN];
    if (!is_bare) plan.of[WORK_FALSE_SUNS] = request->eye_count * WEIGHT[WORK_FALSE_SUNS];
    plan.of[is_bare ? WORK_BARE_SIGHT : WORK_SIGHT] =
        sights * work_of_sight((int)suns_of(condition), is_bare);
    return plan;
}

WorkPlan work_of_condition(const ReviewRequest *request, const ReviewCondition *condition,
                           bool is_bare)
{
    return condition->kind == CONDITION_MOMENT
               ? work_of_moment(request, symbols_of(request), is_bare)
               : work_of_sweep(request, condition, is_bare);
}

double work_of_frame(const ReviewRequest *request, WorkKind kind)
{
    const ReviewFrames *frames = &request->frames;
    double finer = fmax(FRAME_NOISE / frames->noise, 1); /* a frame has some samples at least */
    double share = kind == WORK_PAIR ? FRAME_PAIR : kind == WORK_LAYERS ? FRAME_LAYERS : 1;
    return share * (FRAME + FRAME_PIXEL * frames->width * frames->height * finer * finer);
}

WorkPlan work_of_conditions(const ReviewRequest *request, bool is_bare)
{
    WorkPlan all = {{0}};
    for (int i = 0; i < request->condition_count; i++) {
        WorkPlan one = work_of_condition(request, &request->conditions[i], is_bare);
        work_plan_add(&all, &one, 1);
    }
    return all;
}

/* Those run by themselves: what rides with the review (vary/variants.h) takes little. */
static int varied(const ReviewRequest *request)
{
    int count = 0;
    for (int i = 0; i < request->variant_count; i++)
        count += !review_variant_is_of_levels(request, &request->variants[i]);
    for (int i = 0; i < request->parameter_count; i++)
        count += request->parameters[i].kind == PARAMETER_BRIGHTNESS ? 0 : 2;
    return count;
}

WorkPlan work_of_trial(const ReviewRequest *request, const ReviewParameter *parameter)
{
    WorkPlan plan = work_of_conditions(request, true);
    if (parameter->kind == PARAMETER_BRIGHTNESS)
        plan.of[WORK_RESPONSE] = plan.of[WORK_METER] = plan.of[WORK_OWN] = 0;
    return plan;
}

WorkPlan work_of_review(const ReviewRequest *request, const ReviewParameter *mend)
{
    int      worst = request->frames.worst;
    WorkPlan all = work_of_conditions(request, false);
    WorkPlan bare = work_of_conditions(request, true);
    WorkPlan trial = mend ? work_of_trial(request, mend) : (WorkPlan){{0}};
    work_plan_add(&all, &bare, varied(request));
    work_plan_add(&all, &trial, WORK_TRIALS);
    all.of[WORK_FRAME] = worst * work_of_frame(request, WORK_FRAME);
    all.of[WORK_LAYERS] = worst * work_of_frame(request, WORK_LAYERS);
    all.of[WORK_PAIR] =
        worst ? request->variant_count * work_of_frame(request, WORK_PAIR) : 0;
    return all;
}

/* ---- how fast it goes -------------------------------------------------------------------- */

/* How much longer all takes than by itself. */
static double stretch_of(const Work *work)
{
    return (work->recent_s + RECENT_PRIOR_S) / (work->recent_own_s + RECENT_PRIOR_S);
}

/* Seconds for a weight of 1, by itself. */
static double pace_of(const Work *work, int kind)
{
    double all = (sum_of(&work->seconds) + PRIOR_S) / (sum_of(&work->timed) + PRIOR_S);
    return (work->seconds.of[kind] + PRIOR_KIND * all) / (work->timed.of[kind] + PRIOR_KIND);
}

double work_left_s(const Work *work)
{
    double left = 0;
    for (int k = 0; k < WORK_KINDS; k++)
        left += fmax(work->planned.of[k] - work->done.of[k], 0) * pace_of(work, k);
    return left * stretch_of(work);
}

/* The share that is done is that of the time, and never runs back. */
static void show(Work *work)
{
    Progress *progress = &work->progress;
    double    elapsed = monotonic_seconds() - progress->begun_s, left = work_left_s(work);
    double    share = elapsed + left > 0 ? elapsed / (elapsed + left) : 0;
    progress->left_s = left;
    progress->more_s = 0;
    progress->left_from = fmax(progress->done, share * progress->total);
    progress_update(progress, progress->left_from);
}

Work work_start(ProgressMode mode, const WorkPlan *planned)
{
    Progress progress = progress_start(mode, "review", "steps", sum_of(planned));
    return (Work){.progress = progress, .planned = *planned, .mark_s = progress.begun_s,
                  .mark_waited_s = thread_waited_seconds()};
}

/* Seconds since the last part that the work had by itself. */
static double own_seconds(Work *work)
{
    double now = monotonic_seconds(), waited = thread_waited_seconds();
    double took = now - work->mark_s, kept = exp_d(-took / RECENT_S);
    double own = fmax(took - (waited - work->mark_waited_s), OWN_LEAST * took);
    work->mark_s = now;
    work->mark_waited_s = waited;
    work->recent_s = kept * work->recent_s + took;
    work->recent_own_s = kept * work->recent_own_s + own;
    return own;
}

void work_add(Work *work, WorkKind kind, double weight)
{
    double own = own_seconds(work);
    work->done.of[kind] += weight;
    if (own >= UNTIMED * weight) {
        work->timed.of[kind] += weight;
        work->seconds.of[kind] += own;
    }
    show(work);
}

void work_replan(Work *work, const WorkPlan *before, const WorkPlan *now)
{
    work_plan_add(&work->planned, now, 1);
    work_plan_add(&work->planned, before, -1);
}

double work_share(const Work *work, WorkKind kind, double weight)
{
    const Progress *progress = &work->progress;
    double left = work_left_s(work), own = weight * pace_of(work, kind) * stretch_of(work);
    return left > 0 ? fmin(own / left, 1) * (progress->total - progress->done) : 0;
}

void work_end(Work *work)
{
    work->progress.left_s = 0;
    progress_end(&work->progress, work->progress.total);
}
