/* SPDX-License-Identifier: Apache-2.0 */
/* review_diff.h -- two reviews beside each other: what a change of the design did.
 *
 * Cases belong together by condition, eye and symbol; so do sweeps; gazes by condition, eye and
 * gaze.
 *
 * Memory   lists lie in the arena and point into both reviews. Threads: pure. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "review/verdict.h"

typedef enum DiffKind {
    DIFF_BROKEN, /* the verdict became worse */
    DIFF_MENDED, /* it became better */
    DIFF_WORSE,  /* the same verdict; contrast fell, by more than both intervals allow */
    DIFF_BETTER,
    DIFF_GONE, /* only before */
    DIFF_NEW,  /* only after */
    DIFF_SAME
} DiffKind;
extern const char *const diff_names[7]; /* "broken", "mended", "worse", ... */

typedef struct CaseDiff {
    DiffKind kind;
    const ReviewCase *before, *after; /* NULL: this side does not have it */
} CaseDiff;

typedef struct SweepDiff {
    DiffKind kind; /* by the verdict of the worst, then by the share that failed */
    const ReviewSweep *before, *after;
} SweepDiff;

typedef struct GazeDiff {
    DiffKind kind; /* worse or better: what is left of the contrast */
    const GazeFinding *before, *after;
} GazeDiff;

extern const GazeFinding diff_no_gaze; /* figures of a side that has none: NaN */

typedef struct ReviewDiff {
    const char *before_name, *after_name; /* folders, as the user named them */
    const Review *before, *after;
    CaseDiff *cases; /* in the order of DiffKind, then of the reviews */
    int case_count;
    SweepDiff *sweeps;
    int sweep_count;
    GazeDiff *gazes;
    int gaze_count;
    int count[7]; /* in all, by DiffKind */
} ReviewDiff;

ReviewDiff review_diff(const Review *before, const Review *after, const char *before_name,
                       const char *after_name, Arena *arena);

/* {"before", "after", "pass": [before, after], "count": {...}, "cases": [{"condition", "eye",
 * "symbol", "change", "verdict": [,], "contrast_ratio": [,], "contrast_interval": [[,],[,]],
 * "margin": [,]}], "sweeps": [...], "gazes": [...]}; null for the side that does not have
 * it. */
json_t *review_diff_json(const ReviewDiff *diff);
