/* SPDX-License-Identifier: Apache-2.0 */
/* review_table.h -- the tables of a review's page: all verdicts, the limits, what changed.
 *
 * Rows link to the cards of their cases (review_card_id).
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "review/output/review_diff.h"
#include "review/verdict.h"
#include "text/text.h"

/* For every eye: symbols by conditions, at a glance. An eye with too many has none. */
void review_table_add_matrix(Text *html, const Review *review, Arena *arena);

/* For every sweep: how often each symbol fails each eye, and the least contrast. */
void review_table_add_sweeps(Text *html, const Review *review, Arena *arena);

/* Every case and every sweep's worst with its figures, worst first; most: so many, 0 is all. */
void review_table_add_list(Text *html, const Review *review, int most, Arena *arena);

/* Every limit that was asked, once, with where its value was read. */
void review_table_add_limits(Text *html, const Review *review, Arena *arena);

/* Effects of a change of the design. */
void review_table_add_diff(Text *html, const ReviewDiff *diff, Arena *arena);
