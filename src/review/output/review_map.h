/* SPDX-License-Identifier: Apache-2.0 */
/* review_map.h -- a sweep as pictures: the verdict for every place of the sun, and for every
 * hour of every day.
 *
 * Cells become a picture of one pixel each, letters stay the page's: so a map of all directions
 * is small, and can be read on a telephone.
 *
 * Units    angles in degrees.
 * Memory   values are jansson's, the caller's. Threads: no shared state.
 * Fails    for a picture that cannot be encoded.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "base/error.h"
#include "review/verdict.h"

/* Places along an axis: first, first + step, ... */
typedef struct ReviewAxis {
    double first, step; /* step above 0 */
    int count;          /* at least 1 */
} ReviewAxis;

/* A step of a sweep as it was judged: its row of the sweep's table. */
typedef struct ReviewStep {
    double azimuth_deg, elevation_deg; /* of the sun; azimuth 0 is ahead, 90 right */
    const char *when;                  /* NULL: a sweep without times */
    double contrast, low, high;        /* NaN: not evaluated */
    double margin;                     /* LimitVerdict's (verdict.h); NaN: no limit */
    double reflected, mirror, level, lux;
    Verdict verdict;
} ReviewStep;

/* The verdict for every place of the sun: each cell has the answer of a step. Those of the first
 * elevation's azimuths, then of the second, ... */
typedef struct ReviewMap {
    const ReviewSweep *of; /* one of the review's sweeps: the pointer */
    ReviewAxis azimuth_deg, elevation_deg;
    const ReviewStep *cells;
    bool is_between_steps; /* of a year: what the sun passes between two steps
                              has the answer of the nearer one */
} ReviewMap;

/* What the template map.html shows; the caller's. for_script: with the cells' steps, which the
 * reader may point at (review.js). NULL: *err is filled. */
json_t *review_map_values(const ReviewMap *map, bool for_script, Arena scratch, Error *err);

/* How many headings failed, over the hours of every day, UTC. The array holds the steps of the
 * first day from midnight on, then those of the second, ... */
typedef struct ReviewCalendar {
    const ReviewSweep *of;
    int year, days, steps_a_day; /* days from 1 January on */
    int headings;
    const int *failing; /* -1: the sun is down, or no answer */
} ReviewCalendar;

/* The same of calendar.html. */
json_t *review_calendar_values(const ReviewCalendar *calendar, Arena scratch, Error *err);

/* Small drawings of figures, as inline SVG: a margin, and the luminances of a
 * symbol against the contrast that is required; private to the output.
 *
 * Colours are review.css's. Coordinates along a bar are percent, so that letters keep their
 * size on a telephone.
 *
 * Memory   the arena's. Threads: pure. Fails: never; "" where there is nothing to draw. */

/* Left of the middle: below the limit. From half of it to twice; the line is the interval. */
const char *review_bar_margin(const LimitVerdict *limit, Arena *arena);

/* A share 0..1 as the width of a bar, percent: "62.5". */
const char *review_bar_percent(double share, Arena *arena);

/* Luminances of the bright and the dark part of a symbol, stacked by origin, with a mark where
 * the bright part would reach the limit. Bars and mark are of the sum that the limit's contrast
 * is taken of: the eye's veil is in them only where it is in that (*has_veil). So the bright
 * bar passes the mark exactly where the contrast does. */
const char *review_bar_luminances(const ReviewCase *c, bool *has_veil, Arena *arena);
