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

/* <svg class="rim"> of the frame's size: the images that the case's eye has then, in outline;
 * NULL: none lies before it. */
const char *review_panes_drawn(const Review *review, const ReviewCase *c, Arena *arena);

/* "12.5° up, 6.3° left" */
const char *review_pane_where(const PaneFinding *f, Arena *arena);

/* "centre (centre) in windscreen (glass), ...: 0.116 cd/m2 against 0.140, contrast 0.83 (0.80 to
 * 0.85), at most 0.1 towards road" */
const char *review_pane_words(const PaneFinding *f, Arena *arena);

/* "centre (centre) in windscreen (glass), seen by driver, night": the name of its test. */
const char *review_pane_name(const PaneFinding *f, Arena *arena);
