/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_query.h -- the way down a vertex tree; what tree_query.h calls. HOT.
 *
 * Threads  any number, on a constant Tree. Fails: never.
 */
#pragma once
#include "hemisphere/tree/vertex_tree.h"

/* HOT. The interpolation between vertices. */
void vertex_tree_walk(const Tree *tree, Vec3 direction, TreeTaps *taps);

/* HOT. The same for a place (of octants that the tree has). */
void vertex_tree_walk_place(const Tree *tree, VertexPlace place, TreeTaps *taps);

/* HOT. tree_sum: what a walk found in a vertex tree, summed up. */
void vertex_tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out);
