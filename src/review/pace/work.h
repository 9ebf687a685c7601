/* SPDX-License-Identifier: Apache-2.0 */
/* work.h -- how long the parts of a review take beside each other, for the display of the time
 * that is left.
 *
 * Units    about seconds of the shipped car on two processors: only their ratios count, since
 *          the pace is measured as the work goes on.
 * Threads  pure functions; a Progress has one thread at a time.
 */
#pragma once
#include "base/progress.h"
#include "review/request/request.h"

/* One eye and symbol in a moment; is_bare: light and verdict alone, as in a variant. */
double work_of_case(const ReviewRequest *request, const ReviewEye *eye, bool is_bare);

/* One gaze that is not at a symbol. */
#define WORK_LOOK 1.25

/* A scene: opening it, finding its symbols, training its guides. */
#define WORK_SETUP 2.5
#define WORK_OPENED 0.6 /* of it, until it is open */

/* A sweep, for one eye and symbol: the response to all directions; the skies and each sun; the
 * worst case, read again. */
#define WORK_RESPONSE 1.8
#define WORK_RESPONSE_PATH (WORK_RESPONSE / 65536) /* of the paths of most of them */
#define WORK_OWN 0.25 /* what is read of the scene's own light, once with its displays */
#define WORK_SKIES 0.3
#define WORK_SUN 1.7e-5
#define WORK_WORST 0.62

double work_of_condition(const ReviewRequest *request, const ReviewCondition *condition,
                         bool is_bare);

/* One picture, and its layers on the page. */
double work_of_frame(const ReviewRequest *request);
double work_of_layers(const ReviewRequest *request);

/* The same view with a variant's change. */
double work_of_pair(const ReviewRequest *request);

/* All conditions of a review or (is_bare) a variant. */
double work_of_conditions(const ReviewRequest *request, bool is_bare);

/* How many values --mend is thought to try. */
#define WORK_TRIALS 10

/* Variants, sensitivities and pictures included; mend: the search of --mend, too. */
double work_of_review(const ReviewRequest *request, bool mend);

/* So much more is done. */
void work_add(Progress *work, double weight);

/* Keeps work that was done before a restart out of the pace: what took less than a tenth of
 * its weight counts as such. begun_s: of the monotonic clock. */
void work_done(Progress *work, double weight, double begun_s);
