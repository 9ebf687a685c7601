/* SPDX-License-Identifier: Apache-2.0 */
/* read_on.h -- reads on where a question is open, until it is decided, no paths would decide
 * it, or a budget is spent.
 *
 * Each round reads afresh, by eight times the paths of the reading before it; the last takes
 * what is left of the budget. A look by which a verdict may be called is one more chance to
 * call it wrongly: round r, from 1 on, has the interval that misses the true value with 0.05 /
 * 2^r. So all rounds together are wrong no more often than the first reading, and their
 * intervals hold the true value more often than 95 %.
 *
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "review/light/setup.h"

typedef struct ReadOn {
    Reading reading; /* that is there */
    long    budget;  /* paths of all readings, that one among them; pilots do not count */
    /* Is the question of the goal open after a reading, and would more paths decide it? */
    bool (*is_worth)(void *user, const Reading *reading, Arena scratch);
} ReadOn;

/* goal: that of the reading, with its question. */
Reading setup_read_on(const Setup *setup, const ProbeAim *aim, const ReadingGoal *goal,
                      const ReadOn *from, Arena scratch);

/* Paths of the round after a reading of `last`, with `left` in the budget; 0: it is spent. */
long read_on_paths(long last, long left);

/* The half of a round's interval, times that of 95 %. */
double read_on_widening(int round);

/* So many times the paths that one round would need are a budget in which it comes. */
#define READ_ON_BUDGET 2.2
