/* SPDX-License-Identifier: Apache-2.0 */
/* review_privacy.h -- what is said of a symbol that must not be read (vision/privacy.h).
 *
 * Memory   the document's (jansson), the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "review/verdict.h"

/* Of any case on the page: of what may be read that it may. Of what must not be, V and S, its
 * images in glass, and from where in an eye box it can be read. */
void privacy_set_values(json_t *to, const ReviewCase *c, Arena *arena);

/* What review.json says of it: those figures, and what keeps it from being read. What is
 * infinite is null. NULL: it may be read. */
json_t *privacy_json(const ReviewCase *c);
