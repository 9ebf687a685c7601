/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_unpack.h -- a vertex tree's rows as 16-bit integers, for trees that are evaluated
 * often.
 *
 * Queries take rows of 4-bit planes apart, each row in another format. Unpacked once, a row is
 * loaded as it stands and no branch waits for its format; the numbers and what is done with
 * them are the same, and so is every bit of an answer.
 *
 * Memory   the arena's, 2 bytes a number: four to five times the rows' packed size.
 * Threads  one, before the tree is shared. Fails: never.
 */
#pragma once
#include "hemisphere/vertex/vertex_tree.h"

#define VERTEX_UNPACKED_MOST ((size_t)2 << 20) /* bytes; larger trees stay packed */

/* tree: of vertex_tree_open. */
void vertex_tree_unpack(Tree *tree, Arena *arena);

/* A tree in memory that has a value at every vertex of its lattice, and no details: the fastest
 * to query. All values are 0; the arena holds it. */
Tree vertex_tree_dense(const Geodesic *geodesic, VertexLattice lattice, int components,
                       Arena *arena);

/* Its values, vertices x components: each component in steps of a 32,767th of its largest. */
void vertex_tree_fill(Tree *dense, const float *values);
