/* SPDX-License-Identifier: Apache-2.0 */
/* tree_expand.h -- a whole tree at once, by another way than queries go: what they are held to.
 *
 * Memory   scratch by value. Threads: pure functions. Fails: never.
 */
#pragma once
#include "hemisphere/tree.h"

/* Inverts the whole tree: haar_leaf_count x components floats (of a vertex tree: its values at
 * the leaves' centres). */
void tree_expand(const Tree *tree, float *leaves, Arena scratch);

/* The points at which trees that end at different levels are compared: the finest vertices of
 * a vertex tree, between which every level is linear; of a Haar tree the leaves' centres. */
uint32_t tree_point_count(const Tree *tree);

/* The interpolated function of a tree at the points of a tree that ends at `level`, which is
 * its own or a finer one: components floats each. */
void tree_expand_points(const Tree *tree, int level, float *out);
