/* SPDX-License-Identifier: Apache-2.0 */
/* review_decide.h -- the answer of a whole review: pass or not, how many of what, the worst.
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/finding.h"
#include "review/verdict.h"

/* Sets review->pass, and returns it: of the findings that count (finding.h) none fails, and each
 * could be judged; where the review is strict none is too close either, and no material is
 * without data. */
bool review_decide(Review *review);

/* Findings by their verdict. */
typedef struct ReviewCounts {
    int of[4];     /* by Verdict, those that count */
    int not_asked; /* those that do not */
    int total;
} ReviewCounts;

ReviewCounts review_count(const Review *review);

/* By names, of which NULL is ""; NULL: there is none. */
const ReviewCase *review_case_named(const Review *review, const char *condition, const char *eye,
                                    const char *symbol);

/* Its worst's, which fresh paths decide: steps may fail where that does not. */
Verdict sweep_verdict(const ReviewSweep *sweep);

/* The whole review's: the worst of those that count. One of cases of which none counts passes
 * where some need not be seen; where no limit applies to any it cannot be judged. A strict
 * review that does not pass fails, unless something cannot be judged and nothing fails. */
Verdict review_verdict(const Review *review);

/* Of the ranked findings (finding.h) the cases and the sweeps' worst: review_case_count pointers.
 */
const ReviewCase **review_rank(const Review *review, Arena *arena);

/* The first of them. NULL: there are none. */
const ReviewCase *review_worst(const Review *review, Arena scratch);

/* A case of each display that has some, in the review's order: its panel is what they rest on.
 * review_case_count pointers, *count of them set. */
const ReviewCase **review_displays(const Review *review, int *count, Arena *arena);

/* Is there one that must not be read? */
bool review_has_privacy(const Review *review);

/* The case of the same condition, eye and symbol: a moment's or a sweep's worst; or NULL. */
const ReviewCase *review_case_like(const Review *review, const ReviewCase *like);

/* The case in which the fewest points of a box or ellipse eye pass a symbol, of moments and the
 * worst of sweeps. */
typedef struct ReviewPlaces {
    const ReviewCase *at;
    double passing_share; /* 0..1 of its points: those that can read it; of what
                             must not be read those that surely cannot */
} ReviewPlaces;

/* In the order of the cases; 0: no eye has several places. */
ReviewPlaces *review_places(const Review *review, int *count, Arena *arena);

/* What a review calls a case, and the files that are named by its texts.
 *
 * Memory   the arena's. Threads: pure. Fails: never. */

/* "speed, seen by driver, low sun". */
const char *words_named(const char *subject, const char *eye, const char *condition, Arena *arena);
const char *words_case(const ReviewCase *c, Arena *arena);

/* A part of a file's name from texts of any kind: letters and digits stay, each other character
 * becomes '-', and what is longer is cut. Texts that differ may give the same. */
#define WORDS_FILE_NAME_MOST 80
const char *words_file_name(const char *text, Arena *arena);
