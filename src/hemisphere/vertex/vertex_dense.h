/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_dense.h -- a tree in memory that has a value at every vertex of its lattice, and no
 * details: the fastest to query.
 *
 * Memory   the arena's, 2 bytes a number. Threads: one, before the tree is shared. Fails: never.
 */
#pragma once
#include "hemisphere/vertex/vertex_tree.h"

/* All values are 0. */
Tree vertex_tree_dense(const Geodesic *geodesic, VertexLattice lattice, int components,
                       Arena *arena);

/* Its values, vertices x components: each component in steps of a 32,767th of its largest. */
void vertex_tree_fill(Tree *dense, const float *values);
