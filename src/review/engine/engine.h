/* SPDX-License-Identifier: Apache-2.0 */
/* engine.h -- a whole review, in order: every moment and sweep, then variants, and pictures of
 * the worst cases.
 *
 * Who listens gets each scene (ReviewRun.news).
 *
 * Memory   the review lives in the arena.
 * Threads  starts its own, by run->means.threads; the same review for any count.
 * Fails    as its parts do, or as a listener does. INT, TERM or HUP stop it
 *          (review/keep/frame_kept.h), once signals are watched.
 */
#pragma once
#include "review/run/review_run.h"

/* is_strict: as in review_decide. Pictures and checkpoints are written into the run's folders;
 * nothing else is written here. */
bool review_run(const ReviewRun *run, bool is_strict, Arena *arena, ReviewOutcome *out, Error *err);
