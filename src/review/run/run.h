/* SPDX-License-Identifier: Apache-2.0 */
/* run.h -- a request becomes a review: setup by setup, case by case.
 *
 * Memory   the review lives in the arena; setups use scratch of their own.
 * Threads  starts its own; the same review for any count.
 * Fails    as its parts do. review_run_conditions writes nothing.
 */
#pragma once
#include "review/run/job.h"

/* All moments and sweeps. A run that has a share yields its journal and responses; *out is then
 * meaningless. */
bool review_run_conditions(const ReviewRun *run, Arena *arena, ReviewOutcome *out,
                           Error *err);

/* How much of the work is done already. Every scene is loaded, and its symbols are found, so
 * that what would end the review later is reported now. */
typedef struct ReviewPlan {
    int responses, responses_kept; /* of sweeps; those in the run's folder */
    const char *identity; /* what decides the answers: the program, and a line a condition */
} ReviewPlan;

bool review_plan(const ReviewRun *run, Arena *arena, ReviewPlan *out, Error *err);

/* Before long work: whether all conditions are such as can be reviewed. */
bool review_check(const ReviewRequest *request, Arena scratch, Error *err);
