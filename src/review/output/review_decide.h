/* review_decide.h -- the answer of a whole review: pass or not, how many of what, the worst.
 *
 * Threads  pure. Fails: never.
 */
#pragma once
#include "review/verdict.h"

/* Sets review->pass, and returns it: nothing fails, neither a case nor a sweep; where the
 * review is strict nothing is too close or not visible either. */
bool review_decide(Review *review);

/* Cases by their verdict; a sweep counts as one case, its worst. */
typedef struct ReviewCounts {
    int of[4]; /* by Verdict */
    int total;
} ReviewCounts;

ReviewCounts review_count(const Review *review);

/* How bad a verdict is: pass 0, too close 1, not visible 2, fail 3. */
int verdict_rank(Verdict verdict);

/* The limit that made the case's verdict: of the worst ones that with the least margin. NULL:
 * the case has no limits. */
const LimitVerdict *case_worst_limit(const ReviewCase *c);

/* The worst of all cases and of the sweeps' worst: by verdict, then by the margin of its worst
 * limit. NULL: there are none. */
const ReviewCase *review_worst(const Review *review);
