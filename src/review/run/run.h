/* SPDX-License-Identifier: Apache-2.0 */
/* run.h -- a condition of a request becomes what is found under it: case by case.
 *
 * Memory   what is found lives in the arena; setups use scratch of their own.
 * Threads  starts its own; the same figures for any count.
 * Fails    as its parts do. Nothing is written but responses.
 */
#pragma once
#include "review/run/review_run.h"

/* One moment or sweep, by itself: nothing of it hangs on another condition. */
bool review_run_condition(const ReviewRun *run, int condition_id, Arena *arena, ReviewOutcome *out,
                          Error *err);

/* Has a later condition that is reviewed the same scene? */
bool review_scene_comes_again(const ReviewRun *run, int condition_id);

/* What a reader must know of the whole: approximations, gaps in data. */
void review_add_notes(const ReviewRun *run, Review *review, Arena *arena);

/* How much of the work is done already. Every scene is loaded, and its symbols are found, so
 * that what would end the review later is reported now. */
typedef struct ReviewPlan {
    int responses, responses_kept; /* of sweeps; those in the run's folder */
} ReviewPlan;

bool review_plan(const ReviewRun *run, Arena *arena, ReviewPlan *out, Error *err);

/* Before long work: whether all conditions are such as can be reviewed. */
bool review_check(const ReviewRequest *request, Arena scratch, Error *err);
