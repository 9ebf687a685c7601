/* SPDX-License-Identifier: Apache-2.0 */
/* review_answer.h -- the page's first screen: pass or fail, every symbol as every eye sees it
 * at its worst, and beside them the worst case of all: its picture, when, why and what mends
 * it; private to the output.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    for a picture that cannot be read.
 */
#pragma once
#include "review/output/review_card.h"
#include "review/output/review_map.h"
#include "review/verdict.h"

typedef struct ReviewAnswer {
    const Review        *review;
    const ReviewPicture *pictures; /* the page's */
    int                  picture_count;
    const ReviewMap     *maps;
    int                  map_count;
} ReviewAnswer;

bool review_answer_add(Text *html, const ReviewAnswer *answer, Arena *arena, Error *err);

/* words_directions for a case's sun; NULL: what its azimuth counts from is not known. */
const char *const *review_answer_directions(const ReviewAnswer *answer, const ReviewCase *c,
                                            Arena *arena);

/* File of the page on one symbol alone, no other symbol's: "summary-speed.html". */
const char *review_summary_name(const Review *review, const char *symbol, Arena *arena);
