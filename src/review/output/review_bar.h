/* SPDX-License-Identifier: Apache-2.0 */
/* review_bar.h -- small drawings of figures, as inline SVG: a margin, and the luminances of a
 * symbol against the contrast that is required; private to the output.
 *
 * Colours are review.css's. Coordinates along a bar are percent, so that letters keep their
 * size on a telephone.
 *
 * Memory   the arena's. Threads: pure. Fails: never; "" where there is nothing to draw.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* Left of the middle: below the limit. From half of it to twice; the line is the interval. */
const char *review_bar_margin(const LimitVerdict *limit, Arena *arena);

/* A share 0..1 as the width of a bar, percent: "62.5". */
const char *review_bar_percent(double share, Arena *arena);

/* Luminances of the bright and the dark part of a symbol, stacked by origin, with a mark where
 * the bright part would reach the limit. Bars and mark are of the sum that the limit's contrast
 * is taken of: the eye's veil is in them only where it is in that (*has_veil). So the bright
 * bar passes the mark exactly where the contrast does. */
const char *review_bar_luminances(const ReviewCase *c, bool *has_veil, Arena *arena);
