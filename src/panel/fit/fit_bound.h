/* SPDX-License-Identifier: Apache-2.0 */
/* fit_bound.h -- emission and reflection to the bound that a user requires.
 *
 * Coders are greedy: a tighter bound may take another tree and end up worse. So a required
 * bound is approached via looser ones (0.05, 0.02, 0.01 and so on): the next fit is kept only
 * where its largest error and its rms are no larger, nor its integrals' beyond what the
 * rounding of means leaves. Where the last one keeps a bound already, no fit is made for it.
 *
 * Memory   the arena's. Threads: the options'. Fails: where the loosest fit does.
 */
#pragma once
#include "panel/fit/fit_file.h"

/* Fill a part of the panel, and its notes. */
bool fit_bound_emission(FitParts *parts, Arena *arena, Error *err);
bool fit_bound_reflection(FitParts *parts, Arena *arena, Error *err);

/* The reflection once more, to a bound that nobody required; replaces it and its notes. */
bool fit_bound_loosened(FitParts *parts, float bound, Arena *arena, Error *err);
