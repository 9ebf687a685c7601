/* SPDX-License-Identifier: Apache-2.0 */
/* variants.h -- the review once more for each of its variants, and what they differ by.
 *
 * A variant is read by the same random numbers as the review itself, from no fewer paths, and
 * judged by the light alone: no causes, gazes, false suns, pictures. What its change does not
 * reach is not traced again: responses and readings are found by what decides them
 * (sweep_responses.h, light/question.h); guides and clear skies are the review's
 * (light/inherited.h). Responses end half as long: how long it fails hangs on them alone.
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

/* Riders: variants that change levels of displays and nothing else. They go with the review,
 * setup by setup, and are read from its paths, since light is linear in what shines. Each has a
 * room until review_riders_end.
 *
 * Sets run->riders: the variants, and both ends of the sensitivities' ranges, that can ride.
 * with_parameters: sensitivities are requested. */
void review_riders_start(ReviewRun *run, bool with_parameters, Arena *arena);
void review_riders_end(ReviewRun *run);

/* Before long work: the scenes of all variants and parameters are loaded, and what they name is
 * looked for. */
bool review_variants_check(const ReviewRun *run, Error *err);

/* The review must be complete. Sets outcome->review.variants. */
bool review_variants(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err);

/* A request that is another's but for a change, run for its verdicts, and held against that. */
bool review_variant(const ReviewRun *run, const ReviewVariant *variant, const Review *base,
                    Arena *arena, ReviewVariantFound *out, Error *err);

/* The margin of one case less that of another. */
ReviewDifference review_difference(const Profile *profile, const ReviewCase *before,
                                   const ReviewCase *after);

/* The case or sweep's worst with the least margin of contrast; NULL: none has one. */
const ReviewCase *review_least_margin(const Review *review);
