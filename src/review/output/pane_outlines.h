/* SPDX-License-Identifier: Apache-2.0 */
/* pane_outlines.h -- displays in glass, in outline over an eye's frame.
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/pane_verdict.h"

/* <svg class="rim"> of the frame's size: the images that the case's eye has in its moment.
 * NULL: none lies before it. */
const char *review_panes_drawn(const Review *review, const ReviewCase *c, Arena *arena);
