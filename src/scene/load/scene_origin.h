/* SPDX-License-Identifier: Apache-2.0 */
/* scene_origin.h -- from where a scene's coordinates count, so that far from the world's origin
 * they are as fine as near it.
 *
 * Coordinates are floats: at a distance d they are off by up to 2^-24 d. The distance is taken
 * away while nodes' places are still doubles (gltf/node_place.h), which leaves no more rounding
 * than a scene at the origin has.
 *
 * Rule     of the first file that shows triangles, each primitive is a box; s is the median of
 *          their half diagonals and m the median of their middles, coordinate by coordinate: a
 *          ground that reaches to the horizon counts as one. Where |m| is at most
 *          ORIGIN_IN_SIZES s (the rounding is at most 2^-18 s) the scene's origin is the
 *          world's, and nothing changes. Else it is m, in whole metres, or where s is below
 *          1/ORIGIN_IN_SIZES m in whole parts 2^-n of one: decimals of a file survive. All
 *          files have one origin.
 *
 * Vertices that their file has far from their own node are rounded there already: a warning
 * says so.
 *
 * Units    m.
 * Memory   in the loader's scratch, none of it kept.
 * Threads  one at a time.
 */
#pragma once
#include "scene/gltf/loader.h"

#define ORIGIN_IN_SIZES 64

/* Sets load->origin. files: placed (nodes.h), in their order. */
void scene_origin_find(Loader *load, GltfFile *const *files, int count);
