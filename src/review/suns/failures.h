/* SPDX-License-Identifier: Apache-2.0 */
/* failures.h -- for how long a sweep fails, also between the steps at which it was sampled.
 *
 * Steps that fail one after the other are a stretch. Where it begins and ends is looked for
 * between the steps, so that hours do not round every failure to hours: to a minute; where
 * there are many, until their sum is known to 1 in 1,000, and the longest to a minute. A
 * stretch shorter than a step is met by a step as seldom as it is shorter: it then counts as a
 * whole one, for those that no step met.
 *
 * Step     fails by its figure; a stretch counts when one of its steps fails for sure, by all
 *          of its interval.
 * Units    minutes.
 * Memory   scratch only.
 * Threads  those of the FailureAsk.
 */
#pragma once
#include "review/suns/sweep_suns.h"

typedef enum StepState { STEP_PASSES, STEP_FAILS, STEP_FAILS_SURELY } StepState;

/* Fills states[suns->count] for suns between steps. */
typedef struct FailureAsk {
    void (*states)(void *user, const SweepSuns *suns, unsigned char *states, Arena scratch);
    void  *user;
} FailureAsk;

typedef struct Failures {
    double share;           /* of the time, 0..1 */
    double longest_minutes; /* of the stretches */
} Failures;

/* For sweeps that have times. ask NULL: a stretch ends with its steps. */
Failures sweep_failures(const ReviewCondition *condition, const SweepSuns *suns,
                        const unsigned char *states, const FailureAsk *ask, Arena scratch);
