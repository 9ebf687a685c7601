/* SPDX-License-Identifier: Apache-2.0 */
/* mend.h -- the smallest change of one parameter that makes everything pass.
 *
 * From where it stands, ever larger steps are tried to both sides within its range, the nearer
 * first, until the whole review passes: nothing fails, nothing is too close to call. Then the
 * gap to the last value that does not is halved, by the same random numbers. What is found is
 * made twice more by fresh ones, as two reviews by themselves would be; where one of these does
 * not agree it gives way by what is left of the gap, a few times.
 *
 * Approximate  a value between two that were tried may pass though neither does.
 * Units        the parameter's (request_parameters.h).
 * Memory       from the arena. Threads: starts its own. Fails as a review does.
 */
#pragma once
#include "review/run/job.h"

/* The review must be complete. Of run->mend; adds to outcome->review.mends. */
bool review_mend(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err);
