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
    bool roads_only; /* of others nothing is set, and they are left out */
} GazesArgs;

/* Fills review_look_count(request) findings, eyes fastest; with
 * roads_only those of roads that are evaluated in the condition, one behind the other.
 * Fails where an eye's camera is missing. */
bool setup_gazes(const GazesArgs *gazes, Arena *arena, GazeFinding *out, Error *err);

/* How many roads the request has evaluated in that sweep: gazes times eyes. */
int roads_of_sweep(const ReviewRequest *request, const ReviewCondition *condition);

/* Of a moment that is lit, likewise. */
int roads_of_moment(const Setup *setup);
