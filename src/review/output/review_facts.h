/* SPDX-License-Identifier: Apache-2.0 */
/* review_facts.h -- what is said of a review's worst case beside its verdict, on the page's
 * first screen and on the console alike: when it is, how often, why, and the remedy; of one
 * that cannot be judged why that is, and what would have it judged.
 *
 * Memory   texts from the arena. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* "Remedy": "the display 1.54 times as bright: 2.05 : 1, required >= 2 : 1: passes". */
typedef struct ReviewFact {
    const char *name, *value;
} ReviewFact;

#define REVIEW_FACTS_MOST 24

typedef struct ReviewFacts {
    ReviewFact list[REVIEW_FACTS_MOST];
    int count;
} ReviewFacts;

/* directions: of the case's sun (words_directions); NULL: what its azimuth counts from is not
 * known. */
ReviewFacts review_facts_of(const Review *review, const ReviewCase *c,
                            const char *const *directions, Arena *arena);

/* What a review rests on, in one line that all outputs share.
 *
 * Memory   the arena's. Texts are UTF-8 and not escaped. Threads: pure. Fails: never. */

/* "panel of cluster: synthetic, good, within 0.6 % of its tables of emission and 0.5 % of those
 * reflects; 11 guessed materials (up to 62 % of the light on a symbol); ...": errors of panels
 * are standard errors, which the intervals hold; shares are the greatest of this review's
 * cases, which may be a part of another's. "": nothing is known, as of an older review. */
const char *review_rests_words(const Review *review, Arena *arena);
