/* SPDX-License-Identifier: Apache-2.0 */
/* review_variants.h -- what if: variants beside each other, the best first, and what each
 * changes of every symbol; how margins hang on parameters; the smallest change that mends it.
 *
 * Memory   the arena's, for as long as the page is made. Threads: one at a time. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"
#include "text/text.h"

/* Nothing where the review has none of them. */
void review_variants_add(Text *html, const Review *review, Arena *arena);
