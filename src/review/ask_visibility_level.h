/* SPDX-License-Identifier: Apache-2.0 */
/* ask_visibility_level.h -- the visibility levels of a case, from its luminances: times that a
 * stroke differs from its background by what somebody of an age just sees (vision/visibility.h).
 *
 * Where no veil is known (a sweep's steps, the places of an eye box that are looked through for
 * the worst) there is none.
 *
 * Memory   lists come from the arena. Threads: pure functions. Fails: never: NaN where a figure
 *          is not known.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* The case's list with all that hangs on its luminances, contrasts and glasses (adapted_cd_m2,
 * threshold_cd_m2, level, low, high, doubts) anew; NULL of an empty one. As of contrasts, an end
 * holds the interval of what is reflected, that of the veil in the eye, and what the panel
 * states of its own errors. */
const CaseVisibility *visibility_levels(const ReviewCase *c, Arena *arena);
