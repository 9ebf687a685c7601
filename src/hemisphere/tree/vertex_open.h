/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_open.h -- a vertex tree's blob checked, and decoded to what queries read; and a whole
 * tree at once.
 *
 * Memory   the arena's: two bytes a number, some kilobytes a level. Threads: pure functions.
 * Fails    naming what is wrong.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree/vertex_tree.h"

/* tree_open of a blob whose magic number is VERTEX_MAGIC, at a multiple of 8. */
bool vertex_tree_open(const void *blob, size_t size, const Geodesic *geodesic, Arena *arena,
                      Tree *out, Error *err);

/* The tree's function at the vertices of its lattice: vertex_count x components floats. */
void vertex_tree_expand(const Tree *tree, float *values);

/* The same at the vertices of `level`, the tree's own or a finer one. */
void vertex_tree_expand_level(const Tree *tree, int level, float *values);
