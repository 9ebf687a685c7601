/* SPDX-License-Identifier: Apache-2.0 */
/* worst_frames.h -- pictures of a review that is made: of its worst cases, and of the very
 * worst with each variant's change.
 *
 * Memory   names live in the arena; setups use scratch of their own.
 * Threads  starts its own; the same pictures for any count.
 * Fails    as its parts do.
 */
#pragma once
#include "review/run/job.h"

/* As many as the request requires, into the run's folder; the cases then name them. Where there
 * is any, variants name two of the worst case, without and with their change. */
bool review_frames(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err);
