/* SPDX-License-Identifier: Apache-2.0 */
/* review_variants.h -- what if: variants beside each other, the best first, and what each
 * changes of every symbol.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time.
 * Fails    for a picture that cannot be read.
 */
#pragma once
#include "review/output/review_values.h"

bool values_add_variants(const PageValues *v, Error *err);

/* A variant's least margin, and the case that it moves most where that is another, before and
 * after in the quantity of the limit: a line. */
const char *review_variants_words(const ReviewVariantFound *v, Arena *arena);
