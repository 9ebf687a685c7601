/* SPDX-License-Identifier: Apache-2.0 */
/* review_false_suns.h -- a review's false suns, where mirrors throw the sun into an eye, as a
 * table of its page.
 *
 * Memory   words in the arena. Threads: pure. Fails: never.
 */
#pragma once
#include "review/verdict.h"
#include "text/text.h"

/* Nothing where there are none. */
void review_false_suns_add(Text *html, const Review *review, Arena *arena);
