/* SPDX-License-Identifier: Apache-2.0 */
/* tree_stop.h -- a tree that is read down to a coarser level only.
 *
 * Memory   the arena's, below a vertex tree's base level only: copies of the base rows that
 *          are left. Threads: nobody else may use the tree while it changes. Fails: never.
 */
#pragma once
#include "hemisphere/tree.h"

/* From now on the tree ends at `level` (0 to tree->level). A vertex tree keeps its values at
 * the vertices of that level, to rounding, and is linear between them; a Haar tree keeps the
 * means over its triangles. At tree->level nothing changes. */
void tree_stop(Tree *tree, int level, Arena *arena);
