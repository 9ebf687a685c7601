/* SPDX-License-Identifier: Apache-2.0 */
/* finding.h -- everything that a review judges, as rows: of a symbol in a moment, of a sweep's
 * worst, of a gaze, of a display in glass, of the sun in a mirror. A row has a line for each
 * quantity that a limit applies to. Counts, the order of the worst, text, JSON, CSV, page, JUnit
 * and differences are made of these rows.
 *
 * Memory   the arena's; rows point into the review.
 * Threads  pure functions.
 * Fails    never.
 */
#pragma once
#include "base/arena.h"
#include "review/quantity.h"
#include "review/verdict.h"

typedef struct Finding {
    const char *condition, *viewer; /* names; the viewer is an eye */
    const char *subject;            /* a symbol, a gaze, a display in its pane, a mirror */
    Verdict verdict;                /* the worst of its lines' that count */
    Unjudged why;
    bool counts;                /* in the review's verdict */
    const LimitVerdict *limits; /* its lines */
    int limit_count;
    const LimitVerdict *worst; /* the line that decides; NULL: there is none */
    /* What was read of it: one of these, a sweep's beside its worst's. */
    const ReviewCase *c;
    const ReviewSweep *sweep;
    const GazeFinding *gaze;
    const struct PaneFinding *pane;
    const ReviewFalseSun *sun;
} Finding;

typedef struct Findings {
    Finding *list;
    int count;
} Findings;

/* All of them, in the review's order: cases, sweeps, then the gazes, displays in glass and
 * mirrors to which a limit applies. */
Findings review_findings(const Review *review, Arena *arena);

/* The worst first: what counts before what does not, by verdict (fail, cannot be judged, too
 * close, pass), then by the least margin of the line that decides, else in the review's order. */
Findings review_ranked(const Review *review, Arena *arena);

/* The sweep whose worst this is; NULL: the case is a moment's. */
const ReviewSweep *review_sweep_of(const Review *review, const ReviewCase *c);

/* All cases, then the sweeps' worst, one by one; and how many that are. */
const ReviewCase *review_case_at(const Review *review, int i);
int review_case_count(const Review *review);

/* The limit that made the case's verdict: of those with that verdict the one with the least
 * margin. Where it passes, or there is none, that of the contrast: a height or a stroke is the
 * same under every light, and says nothing there. NULL: no limit counts. Whatever is printed of
 * a case beside its verdict is this limit's: figure, interval, margin. */
const LimitVerdict *case_worst_limit(const ReviewCase *c);

/* "symbol", "sweep", "gaze", "pane", "mirror". */
const char *finding_kind(const Finding *finding);

/* The one of the same condition, viewer and subject and of the same kind; NULL: there is none. */
const Finding *finding_like(const Findings *list, const Finding *like);

/* The line of the same quantity, limit's name, age and pane; NULL: there is none. */
const LimitVerdict *finding_line_like(const Finding *finding, const LimitVerdict *like);
