/* SPDX-License-Identifier: Apache-2.0 */
/* work.h -- how long the parts of a review take, for the display of the time that is left.
 *
 * Work is planned by kinds, each with a weight: about its seconds in the shipped car on two
 * processors. Other scenes and machines take other times, and not of all kinds alike. So each
 * kind has a pace of its own, which is measured while it goes on; a kind that was not met yet
 * goes by the pace of all others. What is left is the sum over kinds of the weight that is left
 * times its pace.
 *
 * Others' load on the machine stretches all kinds alike: paces are those of the time that the
 * work had by itself, without waiting for a processor, and what is left is stretched as much as
 * the last half minute was.
 *
 * Threads  a Work has one thread at a time.
 */
#pragma once
#include "base/progress.h"
#include "review/request/request.h"

typedef enum WorkKind {
    WORK_OPEN,       /* a scene is read, and its symbols are found */
    WORK_LEARN,      /* its guides are trained */
    WORK_CASE,       /* one eye and symbol in a moment */
    WORK_BARE_CASE,  /* its light and verdict alone, as in a variant */
    WORK_LOOK,       /* one gaze that is not at a symbol */
    WORK_RESPONSE,   /* a sweep's response of one eye and symbol */
    WORK_METER,      /* that of a display's face or a sensor */
    WORK_OWN,        /* what one of them reads of the scene's own light */
    WORK_SKIES,      /* a sweep's skies */
    WORK_FALSE_SUNS, /* the sun in mirrors, of one eye */
    WORK_SIGHT,      /* a sight's suns and its worst case */
    WORK_BARE_SIGHT, /* likewise, in a variant */
    WORK_FRAME, WORK_LAYERS, WORK_PAIR, /* a picture, its layers on the page, a variant's */
    WORK_KINDS
} WorkKind;

typedef struct WorkPlan {
    double of[WORK_KINDS]; /* weights */
} WorkPlan;

typedef struct Work {
    Progress progress; /* shows it */
    WorkPlan planned, done, timed, seconds; /* timed: of what is done, what `seconds` holds */
    double   mark_s, mark_waited_s; /* when the last part of it was done */
    double   recent_s, recent_own_s; /* of late, and of that by itself */
} Work;

Work work_start(ProgressMode mode, const WorkPlan *planned);

/* So much of a kind is done since the last was: all that time was its. What took next to none
 * of it was done before a restart, and shows no pace. */
void work_add(Work *work, WorkKind kind, double weight);

/* What was planned as `before` is `now`. */
void work_replan(Work *work, const WorkPlan *before, const WorkPlan *now);

/* Seconds that are left, by the paces so far. */
double work_left_s(const Work *work);

/* For progress_part of work->progress: a part of that kind and weight, of which work_add will
 * show when it is done. */
double work_share(const Work *work, WorkKind kind, double weight);

void work_end(Work *work);

/* ---- what there is to do ----------------------------------------------------------------- */

/* to += times * of */
void work_plan_add(WorkPlan *to, const WorkPlan *of, double times);

/* One eye and symbol in a moment; is_bare: light and verdict alone, as in a variant. */
double work_of_case(const ReviewRequest *request, const ReviewEye *eye, bool is_bare);
double work_of_sight(int suns, bool is_bare);
double work_of_response(int paths);

/* Of kinds that have one weight. */
double work_of(WorkKind kind);

/* A moment with so many symbols; a condition, whose are not known yet. */
WorkPlan work_of_moment(const ReviewRequest *request, int symbols, bool is_bare);
WorkPlan work_of_condition(const ReviewRequest *request, const ReviewCondition *condition,
                           bool is_bare);

/* One picture, its layers on the page, and the same view with a variant's change. */
double work_of_frame(const ReviewRequest *request, WorkKind kind);

/* All conditions of a review or (is_bare) a variant. */
WorkPlan work_of_conditions(const ReviewRequest *request, bool is_bare);

/* How many values --mend is thought to try. */
#define WORK_TRIALS 10

/* A value of a parameter that is tried: of brightness alone by the review's own responses. */
WorkPlan work_of_trial(const ReviewRequest *request, const ReviewParameter *parameter);

/* Variants, sensitivities and pictures included; mend: the parameter of --mend, whose search
 * is, too; or NULL. */
WorkPlan work_of_review(const ReviewRequest *request, const ReviewParameter *mend);
