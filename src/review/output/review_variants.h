/* SPDX-License-Identifier: Apache-2.0 */
/* review_variants.h -- what if: variants beside each other, the best first, and what each
 * changes of every symbol; how margins hang on parameters; the smallest change that mends it.
 *
 * Memory   the arena's, for as long as the page is made. Threads: one at a time. Fails: never.
 */
#pragma once
#include "review/output/review_card.h"

/* Nothing where the review has none of them. pairs: two pictures a variant, without and with
 * its change; those without a file, or all if NULL, are none. Fails as
 * review_card_add_picture. */
bool review_variants_add(Text *html, const Review *review, const ReviewPicture *pairs,
                         Arena *arena, Error *err);

/* A variant's least margin, and the case that it moves most where that is another, before and
 * after in the quantity of the limit: a line. */
const char *review_variants_words(const ReviewVariantFound *v, Arena *arena);
