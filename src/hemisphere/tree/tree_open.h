/* SPDX-License-Identifier: Apache-2.0 */
/* tree_open.h -- checks a tree's blob, of either basis, and makes what queries read.
 *
 * Memory   a Haar tree is views into the blob; a vertex tree's rows are the arena's. Threads:
 *          pure functions. Fails: naming what is wrong.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree.h"

/* Bytes of a blob that tree_build or vertex_tree_build made. */
size_t tree_size(const void *blob);

/* Checks every count, offset, index and finite number of a blob from anywhere, so that no query
 * can leave its `size` bytes. geodesic->level must be at least the tree's (a vertex tree's
 * vertex_plane_level). Fails (ERROR_INPUT) naming what is wrong. */
bool tree_open(const void *blob, size_t size, const Geodesic *geodesic, Arena *arena, Tree *out,
               Error *err);
