/* SPDX-License-Identifier: Apache-2.0 */
/* privacy_page.h -- what the page shows of a symbol that must not be read.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "review/verdict.h"

/* Of any case: of what may be read that it may. */
void privacy_set_values(json_t *to, const ReviewCase *c, Arena *arena);
