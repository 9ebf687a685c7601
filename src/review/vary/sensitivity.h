/* SPDX-License-Identifier: Apache-2.0 */
/* sensitivity.h -- how margins hang on the parameters of a request.
 *
 * Of each parameter the review is made twice, a step below and a step above where it stands (as
 * far as its range allows), by the same random numbers; slopes are differences by the distance.
 * Approximate  a slope over two steps is that of a chord; the worst sun of a sweep is sought
 *              anew on either side.
 * Units        margins by the parameter's unit (request_parameters.h).
 * Memory       from the arena. Threads: starts its own. Fails as a review does.
 */
#pragma once
#include "review/run/job.h"

/* The review must be complete. Sets outcome->review.sensitivities. */
bool review_sensitivities(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena,
                          Error *err);
