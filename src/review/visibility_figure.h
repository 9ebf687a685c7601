/* SPDX-License-Identifier: Apache-2.0 */
/* visibility_figure.h -- the visibility levels of a case, from its luminances.
 *
 * As contrasts are (judge.h): a level's ends hold the interval of what is reflected, and as
 * squares, since they are independent of it and of each other, that of the veil in the eye and
 * what the panel states of its own errors. Where no veil is known (a sweep's steps, the places
 * of an eye box that are looked through for the worst) there is none.
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

/* What a level's doubt below or above it is made of: the share of what paths to the symbol
 * lessen, and whether of the rest the veil's part is more than the panel's. */
typedef struct LevelDoubt {
    double sampling; /* 0 .. 1 */
    bool is_veils;
} LevelDoubt;

LevelDoubt visibility_doubt(const ReviewCase *c, const CaseVisibility *of, bool is_below);
