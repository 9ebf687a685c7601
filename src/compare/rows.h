/* SPDX-License-Identifier: Apache-2.0 */
/* rows.h -- every figure of a comparison as a row, with its interval, limit, verdict and words:
 * console, JSON, JUnit and page are made of these alone.
 *
 * Memory   texts come from the arena that is passed in. Threads: pure. Fails: never.
 */
#pragma once
#include "compare/comparison.h"

/* Fills rows and row_count: contrasts of displays, tested means, metrics. */
void rows_make(const CompareOptions *options, Arena *arena, Comparison *out);
