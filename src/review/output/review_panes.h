/* SPDX-License-Identifier: Apache-2.0 */
/* review_panes.h -- what pages and the console say of displays in glass.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time. Fails: never.
 */
#pragma once
#include "review/output/review_values.h"
#include "review/pane_verdict.h"

/* Nothing of a review without any. */
void values_add_panes(const PageValues *v);

/* "centre (centre) in windscreen (glass), 14.2° up, 16.6° right: 0.116 cd/m² against 0.140,
 * contrast 0.83 (0.80 to 0.85), at most 0.1 towards road" */
const char *review_pane_words(const PaneFinding *f, Arena *arena);

/* "centre (centre) in windscreen (glass), seen by driver, night": the name of its test. */
const char *review_pane_name(const PaneFinding *f, Arena *arena);
