/* SPDX-License-Identifier: Apache-2.0 */
/* review_facts.h -- what is said of a review's worst finding beside its verdict, on the page's
 * first screen and on the console alike: when it is, how often, what to do, and why; of one
 * that cannot be judged why that is, and what would have it judged.
 *
 * Memory   texts from the arena. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/finding.h"

/* "What to do": "raise the brightness level from 25 % to 38.5 %: contrast 2.05 : 1 (minimum 2 :
 * 1)". */
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
ReviewFacts review_facts_of(const Review *review, const Finding *f, const char *const *directions,
                            Arena *arena);

/* "Passes by day; night has no limit in this profile": the whole review's outcome as page,
 * console and review.json say it, with all that was not judged for want of a limit. */
const char *review_outcome_words(const Review *review, Arena *arena);

/* One of what a review rests on: "11 guessed materials", and at length. Errors of panels are
 * standard errors, which the intervals hold; shares are the greatest of this review's cases,
 * which may be a part of another's. */
typedef struct RestWords {
    const char *id; /* "panels", ... */
    const char *chip, *words;
} RestWords;

/* How many of them; none: nothing is known, as of an older review. */
int review_rests(const Review *review, RestWords out[REST_KINDS], Arena *arena);

/* All of them in one line. */
const char *review_rests_words(const Review *review, bool is_short, Arena *arena);
