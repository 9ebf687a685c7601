/* SPDX-License-Identifier: Apache-2.0 */
/* review_gaze.h -- the part of a review's page about eyes that look elsewhere than at symbols:
 * what blinds them, what the glass before them mirrors, and what is left to be seen; and where
 * mirrors throw the sun into an eye.
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "review/verdict.h"
#include "text/text.h"

/* Nothing where the review has no such gazes. */
void review_gaze_add(Text *html, const Review *review, Arena *arena);

/* cd m^-2 that glass mirrors over the gaze, and that the eye's own veil lays over it, with no
 * more digits than their intervals allow. */
const char *review_gaze_mirrored(const GazeFinding *g, Arena *arena);
const char *review_gaze_veil(const GazeFinding *g, Arena *arena);

/* Nothing where there are none. */
void review_gaze_add_false_suns(Text *html, const Review *review, Arena *arena);
