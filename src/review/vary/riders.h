/* SPDX-License-Identifier: Apache-2.0 */
/* riders.h -- variants that change levels of displays and nothing else: they go with the
 * review, setup by setup, and are read from its paths, since light is linear in what shines.
 *
 * Memory   from the arena, and a room of each, until review_riders_end.
 * Threads  as a review.
 */
#pragma once
#include "review/run/job.h"

/* Sets run->riders: the variants, and both ends of the sensitivities' ranges, that can ride.
 * with_parameters: sensitivities are wanted. */
void review_riders_start(ReviewRun *run, bool with_parameters, Arena *arena);
void review_riders_end(ReviewRun *run);

/* The variant's rider; NULL: it is run by itself. */
const ReviewRider *review_rider_of(const ReviewRun *run, const ReviewVariant *variant);
