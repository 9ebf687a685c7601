/* SPDX-License-Identifier: Apache-2.0 */
/* tree_open.h -- checks a tree's blob, of either basis, and makes the view that queries read.
 *
 * Memory   views into the blob. Threads: pure functions. Fails: naming what is wrong.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree.h"

/* Bytes of a blob that tree_build or vertex_tree_build made. */
size_t tree_size(const void *blob);

/* Checks every count, offset, index and finite number of a blob from anywhere, so that no query
 * can leave its `size` bytes, and makes the view. geodesic->level must be at least the tree's
 * (a vertex tree's vertex_plane_level). Fails (ERROR_INPUT) naming what is wrong. */
bool tree_open(const void *blob, size_t size, const Geodesic *geodesic, Tree *out, Error *err);

/* For a tree that is evaluated often: a vertex tree's rows as integers in the arena, where they
 * take VERTEX_UNPACKED_MOST bytes at most (vertex_unpack.h); others stay as they are. Every
 * answer keeps its bits. Before the tree is shared by threads. */
void tree_unpack(Tree *tree, Arena *arena);
