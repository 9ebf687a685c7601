/* SPDX-License-Identifier: Apache-2.0 */
/* share.h -- which questions of a review one of several processes answers.
 *
 * Those of a moment are its cases and gazes. The moments lie side by side, all of one size,
 * and each is cut evenly into its questions: a part has one stretch of that, so that it opens
 * few moments. Of the sights of a sweep (a symbol as an eye sees it) it has every count-th,
 * with the responses that those take, and reads the worst case of each; of the eyes, likewise,
 * where mirrors show the sun. The merge answers what is needed once: causes, frames, how often
 * the sun is in mirrors.
 *
 * Threads  pure functions.
 */
#pragma once
#include <stdbool.h>

typedef struct ReviewShare {
    int index, count; /* count 0: all questions are its own */
} ReviewShare;

/* A share of one moment: the place-th of `moments`. */
typedef struct MomentShare {
    ReviewShare of;
    int         place, moments;
} MomentShare;

/* Whether it has the at-th of `count` questions of the moment. */
bool moment_share_has(const MomentShare *share, int at, int count);

/* Whether it may have any, however many questions there are. */
bool moment_share_has_any(const MomentShare *share);

/* The same of the at-th sight of a sweep. */
bool review_share_has(const ReviewShare *share, int at);
