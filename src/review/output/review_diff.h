/* SPDX-License-Identifier: Apache-2.0 */
/* review_diff.h -- two reviews beside each other: what a change of the design did.
 *
 * Findings (review/finding.h) belong together by condition, viewer and subject; their lines by
 * quantity, limit, age and pane. What no limit applies to is compared, too: the contrast and the
 * visibility levels of each case, what is left of a distant object's contrast along each gaze.
 *
 * Memory   lists lie in the arena and point into both reviews. Threads: pure. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "review/finding.h"

typedef enum DiffKind {
    DIFF_BROKEN, /* the verdict became worse */
    DIFF_MENDED, /* it became better */
    DIFF_WORSE,  /* the same verdict; a figure fell by more than both intervals allow, or a sweep
                    fails more often */
    DIFF_BETTER,
    DIFF_GONE, /* only before */
    DIFF_NEW,  /* only after */
    DIFF_SAME, /* no figure moved beyond both intervals */
    DIFF_COUNT
} DiffKind;
extern const char *const diff_names[DIFF_COUNT]; /* "broken", "mended", "worse", ... */

typedef struct FindingDiff {
    DiffKind kind;
    const Finding *before, *after; /* NULL: this side does not have it */
    const LimitVerdict *line[2];   /* before, after: the figure that moved, else the one that
                                      decides; NULL: there is none */
} FindingDiff;

typedef struct ReviewDiff {
    const char *before_name, *after_name; /* folders, as the user named them */
    const Review *before, *after;
    FindingDiff *list; /* in the order of DiffKind, then of the reviews */
    int list_count;
    int count[DIFF_COUNT];
} ReviewDiff;

ReviewDiff review_diff(const Review *before, const Review *after, const char *before_name,
                       const char *after_name, Arena *arena);

/* What a variant does to all that is judged besides symbols: gazes, displays in glass, mirrors.
 * The list lies in the arena, *count of them. */
const FindingDiff *review_diff_beside(const Review *review, const Review *variant, int *count,
                                      Arena *arena);

/* "road, seen by driver, night: threshold increment 24.7 % at 70 years → 9.9 % at 70 years, fail →
 * pass". */
const char *review_diff_words(const FindingDiff *diff, Arena *arena);

/* Of one. */
json_t *finding_diff_json(const FindingDiff *diff);

/* {"before", "after", "pass": [before, after], "count": {...}, "findings": [{"condition", "eye",
 * "subject", "change", "verdict": [,], "lines": [{"quantity", "limit", "age_years", "pane",
 * "found": [,], "interval": [[,],[,]], "margin": [,]}]}]}, of a sweep "failed_share" and
 * "longest_failure_minutes", too; null for the side that does not have it. */
json_t *review_diff_json(const ReviewDiff *diff);
