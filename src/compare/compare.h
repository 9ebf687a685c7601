/* SPDX-License-Identifier: Apache-2.0 */
/* compare.h -- are two frames or pictures the same, given their noise?
 *
 * Different under any limits: sizes, windows, channels, metadata that decides what
 * the picture shows, NaN and infinity in light. Beyond that the limits that were set decide;
 * without any, frames that state their noise are judged by the statistical test, and all others
 * must be equal in every pixel.
 *
 * Memory   results come from the arena that is passed in.
 * Threads  `threads` of its own for FLIP.
 * Fails    when the two cannot be compared at all (kinds, masks, no noise layers for a test
 *          that was requested); a difference is no failure but the answer.
 */
#pragma once
#include "compare/comparison.h"

/* Reads both and compares them. */
bool compare_files(const char *reference, const char *test, const CompareOptions *options,
                   Arena *arena, Comparison *out, Error *err);

/* Two sides that are read already. */
bool compare_inputs(const CompareInput *reference, const CompareInput *test,
                    const CompareOptions *options, Arena *arena, Comparison *out, Error *err);
