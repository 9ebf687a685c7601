/* SPDX-License-Identifier: Apache-2.0 */
#include "review/pace/work.h"

#include <math.h>

#define FOUND_LIKELY 6      /* symbols of a rectangle in which text is found */
#define CASE 0.28           /* of an eye's point, with its causes */
#define CASE_BARE 0.15
#define CASE_COMPARED 0.1  /* more, of a review with variants */
#define POINT 0.015         /* of each further point of an eye's box */
#define FRAME 42.0          /* of a frame, however small, */
#define FRAME_PIXEL 6e-5    /* and its pixels, at the usual noise */
#define FRAME_PAIR 0.3      /* of it, of a variant's */
#define FRAME_LAYERS 0.17   /* of it, of what a reader may move on the page */
#define FRAME_NOISE 0.15    /* reached by about as many samples as any frame has */
#define MINUTES_A_YEAR (365 * 24 * 60.0)

double work_of_case(const ReviewRequest *request, const ReviewEye *eye, bool is_bare)
{
    double more = request->is_compared ? CASE_COMPARED : 0;
    return (is_bare ? CASE_BARE : CASE) + more + POINT * (review_eye_count(eye) - 1);
}

static int symbols_of(const ReviewRequest *request)
{
    int count = 0;
    for (int i = 0; i < request->symbol_count; i++)
        count += request->symbols[i].find_text ? FOUND_LIKELY : 1;
    return count;
}

static double work_of_moment(const ReviewRequest *request, bool is_bare)
{
    double work = WORK_SETUP;
    for (int e = 0; e < request->eye_count; e++)
        work += symbols_of(request) * work_of_case(request, &request->eyes[e], is_bare);
    return is_bare ? work : work + WORK_LOOK * review_look_count(request);
}

/* About: of a year half are up. */
static double suns_of(const ReviewCondition *c)
{
    if (c->kind == CONDITION_ROUTE) return c->route.count;
    if (c->kind == CONDITION_SUN_SWEEP)
        return (double)c->azimuth_deg.count * c->elevation_deg.count;
    return 0.5 * MINUTES_A_YEAR / c->step_minutes * c->heading_count;
}

static double work_of_sweep(const ReviewRequest *request, const ReviewCondition *condition)
{
    int    sights = request->eye_count * symbols_of(request);
    double suns = suns_of(condition);
    double each = WORK_RESPONSE + 2 * WORK_OWN + WORK_SKIES + WORK_SUN * suns + WORK_WORST;
    return WORK_SETUP + sights * each;
}

double work_of_condition(const ReviewRequest *request, const ReviewCondition *condition,
                         bool is_bare)
{
    return condition->kind == CONDITION_MOMENT ? work_of_moment(request, is_bare)
                                               : work_of_sweep(request, condition);
}

double work_of_frame(const ReviewRequest *request)
{
    const ReviewFrames *frames = &request->frames;
    double finer = fmax(FRAME_NOISE / frames->noise, 1); /* a frame has some samples at least */
    return FRAME + FRAME_PIXEL * frames->width * frames->height * finer * finer;
}

double work_of_layers(const ReviewRequest *request)
{
    return FRAME_LAYERS * work_of_frame(request);
}

double work_of_pair(const ReviewRequest *request)
{
    return FRAME_PAIR * work_of_frame(request);
}

double work_of_conditions(const ReviewRequest *request, bool is_bare)
{
    double work = 0;
    for (int i = 0; i < request->condition_count; i++)
        work += work_of_condition(request, &request->conditions[i], is_bare);
    return work;
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

double work_of_review(const ReviewRequest *request, bool mend)
{
    int runs = varied(request) + (mend ? WORK_TRIALS : 0);
    return work_of_conditions(request, false) + runs * work_of_conditions(request, true) +
           request->frames.worst * (work_of_frame(request) + work_of_layers(request)) +
           (request->frames.worst ? request->variant_count * work_of_pair(request) : 0);
}

void work_add(Progress *work, double weight)
{
    progress_update(work, work->done + weight);
}

void work_done(Progress *work, double weight, double begun_s)
{
    if (monotonic_seconds() - begun_s >= 0.1 * weight) return;
    while (work->outer) work = work->outer;
    work->first += weight;
}
