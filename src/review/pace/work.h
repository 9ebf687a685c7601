/* SPDX-License-Identifier: Apache-2.0 */
/* work.h -- how long the parts of a review take beside each other, so that a person who waits
 * is told when it will be done.
 *
 * Units    about seconds of the shipped car on two processors: only their ratios count, since
 *          the pace is measured as the work goes on.
 * Threads  pure functions; a Progress has one thread at a time.
 */
#pragma once
#include "base/progress.h"
#include "review/request/request.h"

/* Of an eye and a symbol in a moment; bare: of a variant. */
double work_of_case(const ReviewRequest *request, const ReviewEye *eye, bool is_bare);

/* Of a gaze that does not go to symbols. */
#define WORK_LOOK 1.25

/* Of a scene that is opened, its symbols found, its paths taught. */
#define WORK_SETUP 2.5
#define WORK_OPENED 0.6 /* of it, until it is open */

/* Of a sweep: a symbol that an eye sees, which is asked of every direction; of skies, and each
 * sun that it is asked of then; and its worst, read again. */
#define WORK_RESPONSE 1.8
#define WORK_RESPONSE_PATH (WORK_RESPONSE / 65536) /* of the paths of most of them */
#define WORK_OWN 0.25 /* what is read of the scene's own light, once with its displays */
#define WORK_SKIES 0.3
#define WORK_SUN 1.7e-5
#define WORK_WORST 0.62

double work_of_condition(const ReviewRequest *request, const ReviewCondition *condition,
                         bool is_bare);

/* Of one picture; and of what the page makes of it. */
double work_of_frame(const ReviewRequest *request);
double work_of_layers(const ReviewRequest *request);

/* Of one that stands beside it, with a variant's change. */
double work_of_pair(const ReviewRequest *request);

/* Of all conditions of a review or a variant. */
double work_of_conditions(const ReviewRequest *request, bool is_bare);

/* How many values --mend is thought to try. */
#define WORK_TRIALS 10

/* Of everything: variants, sensitivities, pictures; mend: of that search, too. */
double work_of_review(const ReviewRequest *request, bool mend);

/* So much more is done. */
void work_add(Progress *work, double weight);

/* Work that was found done from before a kill says nothing of the pace: what took less than a
 * tenth of its weight counts as such. begun_s: of the monotonic clock. */
void work_done(Progress *work, double weight, double begun_s);
