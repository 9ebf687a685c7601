/* SPDX-License-Identifier: Apache-2.0 */
/* join.h -- what was found of each condition becomes a review: rows behind each other, in the
 * order in which they are passed.
 *
 * Memory   lists lie in the arena; what their rows point to stays where it is.
 * Threads  pure.
 * Fails    never.
 */
#pragma once
#include "review/run/review_run.h"

/* Neither decided nor compared yet. */
void review_join(const ReviewRun *run, const ReviewOutcome *const *parts, int count, Arena *arena,
                 ReviewOutcome *out);
