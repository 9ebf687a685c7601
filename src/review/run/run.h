/* run.h -- a request becomes a review: stage by stage, case by case.
 *
 * Memory   the review lives in the arena; stages use scratch of their own.
 * Threads  starts its own; the same review for any count.
 * Fails    as its parts do; nothing but frames is written here.
 */
#pragma once
#include "review/run/job.h"

bool review_run(const ReviewRun *run, Arena *arena, ReviewOutcome *out, Error *err);
