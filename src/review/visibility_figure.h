/* SPDX-License-Identifier: Apache-2.0 */
/* visibility_figure.h -- the visibility levels of a case, from its luminances.
 *
 * As contrasts are (judge.h): a level's ends hold the interval of what is reflected, and what
 * the panel states of its own errors. The doubt of the veil in the eye is not in them. Where no
 * veil is known (a sweep's steps, the places of an eye box that are looked through for the
 * worst) there is none.
 *
 * Memory   lists come from the arena.
 * Threads  pure functions.
 * Fails    never: NaN where a figure is not known.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* The case's list with all that hangs on its luminances, contrasts and glasses (adapted_cd_m2,
 * threshold_cd_m2, level, low, high, doubts) anew; NULL of an empty one. */
const CaseVisibility *visibility_levels(const ReviewCase *c, Arena *arena);

/* Whose level a limit is about: the least of all, of an upper limit the greatest. One that is
 * not known comes before all others. NULL: the list is empty. */
const CaseVisibility *visibility_decisive(const ReviewCase *c, bool is_upper);

/* The share of sampling in a level's doubt below or above it, 0 .. 1. */
double visibility_sampling_share(const ReviewCase *c, const CaseVisibility *of, bool is_below);
