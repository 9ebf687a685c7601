/* SPDX-License-Identifier: Apache-2.0 */
/* review_rays.h -- lines over the picture of a case's frame: around its symbol, and the rays of
 * its causes. A reader chooses a cause, and its rays are shown; links alone do that (:target),
 * no script. Private to the output.
 *
 * Lines are cut at the picture's edge.
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"
#include "review/pane_verdict.h"

/* Does cause i have rays that the frame can show? */
bool review_rays_has(const ReviewCase *c, int i);

/* "c3-way2", where a link to the rays of cause i of the card "c3" goes. */
const char *review_rays_id(const char *card_id, int i, Arena *arena);

/* <svg class="rim"> of the frame's size: a line around the symbol, a little outside it, cut
 * where a picture of object-fit: cover is. "" where the symbol's rim is not known. */
const char *review_rays_rim(const ReviewCase *c, Arena *arena);

/* The same line alone, of a drawing in the frame's pixels: <g class="rim">. The rim must be
 * known. */
const char *review_rays_line(const ReviewCase *c, Arena *arena);

/* What of the frame shows the symbol close up, with about it what is on its display: left, top,
 * width, height, pixels, of the frame's proportions. False: the rim is not known, or not in the
 * frame. */
bool review_rays_close_up(const ReviewCase *c, double box[4]);

/* <svg class="rays"> of the frame's size, a group for each cause. */
const char *review_rays_drawn(const ReviewCase *c, const char *card_id, Arena *arena);

/* <svg class="rim"> of the frame's size: the images that the case's eye has in its moment.
 * NULL: none lies before it. */
const char *review_panes_drawn(const Review *review, const ReviewCase *c, Arena *arena);
