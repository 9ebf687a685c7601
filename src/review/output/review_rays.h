/* SPDX-License-Identifier: Apache-2.0 */
/* review_rays.h -- the rays of a case's causes over the picture of its frame: a reader chooses
 * a cause, and its rays are shown. Links alone do that (:target), no script; private to the
 * output.
 *
 * Lines are cut at the picture's edge.
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "review/verdict.h"
#include "text/text.h"

/* Does cause i have rays that the frame can show? */
bool review_rays_has(const ReviewCase *c, int i);

/* "c3-way2", where a link to the rays of cause i of the card "c3" goes. */
const char *review_rays_id(const char *card_id, int i, Arena *arena);

/* <svg class="rays"> of the frame's size, a group for each cause. */
void review_rays_add(Text *html, const ReviewCase *c, const char *card_id, Arena *arena);
