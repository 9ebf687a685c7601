/* SPDX-License-Identifier: Apache-2.0 */
/* review_bar.h -- small drawings of figures, as inline SVG: a margin, a share, and the
 * luminances of a symbol against the contrast that is wanted; private to the output.
 *
 * Colours are review.css's. Coordinates along a bar are percent, so that letters keep their
 * size on a telephone.
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "review/verdict.h"
#include "text/text.h"

/* Left of the middle: below the limit. From half of it to twice; the line is the interval. */
void review_bar_add_margin(Text *html, const LimitVerdict *limit);

/* A share 0..1 as a thin bar. */
void review_bar_add_share(Text *html, double share);

/* Luminances of the bright and the dark part of a symbol, stacked by origin, with a mark where
 * the bright part would reach the limit; then all figures. Bars and mark are of the sum that
 * the limit's contrast is taken of: the eye's veil is in them only where it is in that. So the
 * bright bar passes the mark exactly where the contrast does. */
void review_bar_add_luminances(Text *html, const ReviewCase *c, Arena *arena);
