/* SPDX-License-Identifier: Apache-2.0 */
/* gazes.h -- eyes that look elsewhere than at symbols, such as at the road, in a setup that is
 * lit: what blinds them, and what the glass before them mirrors.
 *
 * An eye box counts by the point whose view has the most light laid over it.
 *
 * Units    verdict.h's.
 * Memory   texts lie in the arena.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "review/eye/false_suns.h"
#include "review/run/review_run.h"
#include "review/verdict.h"

typedef struct GazesArgs {
    const Setup *setup;
    SunSearches *searches;
    const Profile *profile;  /* limits of roads */
    const ReviewCase *cases; /* of this moment, which are made before */
    int case_count;
    bool roads_only; /* those that are evaluated in the condition */
} GazesArgs;

/* Adds findings, eyes fastest, to the review's, which have room for review_look_count(request).
 * Fails where an eye's camera is missing. */
bool setup_gazes(const GazesArgs *gazes, Arena *arena, Review *review, Error *err);

/* Are any roads evaluated in that sweep? */
bool sweep_has_roads(const ReviewRequest *request, const ReviewCondition *condition);
