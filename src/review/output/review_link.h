/* SPDX-License-Identifier: Apache-2.0 */
/* review_link.h -- where what is on which page of a review.
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* "c3" of the fourth case, "s0" of the first sweep's worst. */
const char *review_card_id(const Review *review, const ReviewCase *c, Arena *arena);

/* The page that has the cards which the review's own leaves out (Review.main_cards). */
#define REVIEW_PAGE_BESIDE "cases.html"

/* Whether its card is on the page that the review is about. */
bool review_card_is_here(const Review *review, const ReviewCase *c, Arena scratch);

/* Where its card is: "#c3", or on the other page. */
const char *review_card_link(const Review *review, const ReviewCase *c, Arena *arena);

/* File of the page on one symbol alone, no other symbol's: "summary-speed.html". */
const char *review_summary_name(const Review *review, const char *symbol, Arena *arena);
