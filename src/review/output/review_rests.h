/* SPDX-License-Identifier: Apache-2.0 */
/* review_rests.h -- what a review rests on, in one line that all outputs share.
 *
 * Memory   the arena's. Texts are UTF-8 and not escaped. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* "panel of cluster: synthetic, good, known within 0.6 % of what it emits and 0.5 % of what it
 * reflects; 11 guessed materials (up to 62 % of the light on a symbol); ...": errors of panels
 * are standard errors, which the intervals hold; shares are the greatest of this review's
 * cases, which may be a part of another's. "": nothing is known, as of an older review. */
const char *review_rests_words(const Review *review, Arena *arena);
