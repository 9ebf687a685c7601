/* SPDX-License-Identifier: Apache-2.0 */
/* variants.h -- the review once more for each of its variants, and what they differ by.
 *
 * A variant is this review with another request: read by the same random numbers as the review
 * itself, from no fewer paths, and judged by the light alone: no causes, gazes, false suns,
 * pictures. Responses are found by what decides them (sweep_probes.h). They end half as long:
 * how long it fails hangs on them alone.
 *
 * Intervals  of differences of margins: jackknife over the batches of both readings, which are
 *            independent of each other and share their luck pair by pair; Student's t for 95 %.
 *            The error of what is known without paths, the same on both sides, is not in it.
 * Source     B. Efron, The Jackknife, the Bootstrap and Other Resampling Plans, SIAM 1982
 * Memory     from the arena.
 * Threads    starts its own; the same figures for any count.
 * Fails      as a review does, naming the variant.
 */
#pragma once
#include "review/run/job.h"

/* Before long work: the scenes of all variants and parameters are loaded, and what they name is
 * looked for. */
bool review_variants_check(const ReviewRun *run, Error *err);

/* The review must be complete. Sets outcome->review.variants. */
bool review_variants(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err);

/* ---- how margins hang on a number -------------------------------------------------------- */

/* How margins hang on the parameters of a request.
 *
 * Of each parameter the review is made twice, a step below and a step above where it stands (as
 * far as its range allows), by the same random numbers; slopes are differences by the distance.
 * Approximate  a slope over two steps is that of a chord; the worst sun of a sweep is sought
 *              anew on either side.
 * Units        margins by the parameter's unit (request_parameters.h).
 * Memory       from the arena. Threads: starts its own. Fails as a review does. */

/* The review must be complete. Sets outcome->review.sensitivities. */
bool review_sensitivities(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena,
                          Error *err);

/* ---- the smallest change that remedies --------------------------------------------------- */

/* The smallest change of one parameter that makes everything pass.
 *
 * From where it stands, ever larger steps are tried to both sides within its range, the nearer
 * first, until the whole review passes: nothing fails, nothing is too close to call. Then the
 * gap to the last value that does not is halved, by the same random numbers. What is found is
 * made twice more by fresh ones, as two reviews by themselves would be; where one of these does
 * not agree it gives way by what is left of the gap, a few times.
 *
 * Approximate  a value between two that were tried may pass though neither does.
 * Units        the parameter's (request_parameters.h).
 * Memory       from the arena. Threads: starts its own. Fails as a review does. */

/* The review must be complete. Of run->mend; adds to outcome->review.mends. */
bool review_mend(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err);
