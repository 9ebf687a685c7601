/* SPDX-License-Identifier: Apache-2.0 */
/* variants.h -- the review once more for each of its variants, and what they differ by.
 *
 * A variant is this review with another request: read by the same random numbers as the review
 * itself, from no fewer paths, where its light is not alike (run/alike.h), and judged by that
 * alone: no causes, gazes, false suns, pictures. Responses are found by what decides them
 * (sweep_probes.h). They end half as long: how long it fails hangs on them alone.
 *
 * Intervals  of differences of margins: jackknife over the batches of both readings, which are
 *            independent of each other and share their luck pair by pair; Student's t for 95 %.
 *            The error of what is known without paths, the same on both sides, is not in it; that
 *            by which light is alike is.
 * Source     B. Efron, The Jackknife, the Bootstrap and Other Resampling Plans, SIAM 1982
 * Memory     from the arena.
 * Threads    starts its own; the same figures for any count.
 * Fails      as a review does, naming the variant.
 */
#pragma once
#include "review/run/review_run.h"

/* Before long work: the scenes of all variants are loaded, and what they name is looked for. */
bool review_variants_check(const ReviewRun *run, Error *err);

/* The variant under one condition; run->base: the review under that. */
bool review_variant_condition(const ReviewRun *run, const ReviewVariant *variant, int condition_id,
                              Arena *arena, ReviewOutcome *out, Error *err);

/* A variant that was read under all conditions, held against the review, which gets its
 * files. */
void review_variant_compare(const ReviewRun *run, const ReviewVariant *variant, Review *base,
                            Review *found, Arena *arena, ReviewVariantFound *out);
