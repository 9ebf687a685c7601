/* SPDX-License-Identifier: Apache-2.0 */
/* ray_file.h -- the rays of a case's causes as glTF 2.0: lines that any viewer shows beside the
 * scene, in its metres: numbers are the scene's coordinates, nodes stand at its origin.
 *
 * Each cause is a mesh of its own (mode LINES), with its own colour, or its light's, and its
 * chain as the node's name; `extras` of the node hold its share, its cd/m^2 and the contrast
 * without it.
 * NAME.gltf holds its numbers itself; NAME.glb is the binary form.
 *
 * Memory   scratch only.
 * Threads  no shared state.
 * Fails    for another ending, and where the file cannot be written.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "review/verdict.h"

/* Before long work: would ray_file_write take the name? */
bool ray_file_check(const char *path, Error *err);

bool ray_file_write(const ReviewCase *c, const char *path, Error *err);

/* Lines over the picture of a case's frame: around its symbol, and the rays of
 * its causes. A reader chooses a cause, and its rays are shown; links alone do that (:target),
 * no script. Private to the output.
 *
 * Lines are cut at the picture's edge.
 *
 * Memory   the arena's. Threads: pure. Fails: never. */

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
