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
#include "base/error.h"
#include "review/verdict.h"

/* Before long work: would ray_file_write take the name? */
bool ray_file_check(const char *path, Error *err);

bool ray_file_write(const ReviewCase *c, const char *path, Error *err);

/* sRGB of cause i, 0..1: distinct without colour vision, too, by their order in lightness. */
void ray_colour(int i, float srgb[3]);
