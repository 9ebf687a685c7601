/* SPDX-License-Identifier: Apache-2.0 */
/* review_table.h -- the tables of a review's page: all verdicts, the limits, what changed.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time. Fails: never.
 */
#pragma once
#include "review/output/review_values.h"

/* Symbols by conditions for every eye, and by eyes for every sweep's condition; what has too
 * many has none. */
void values_add_matrices(const PageValues *v);

/* Every case and every sweep's worst, the worst first; most: so many, 0 is all. */
void values_add_list(const PageValues *v, int most);

/* Every limit that was requested, once, with where its value was read. */
void values_add_limits(const PageValues *v);

/* Effects of a change of the design. */
void values_add_diff(const PageValues *v);
