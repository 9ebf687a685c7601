/* SPDX-License-Identifier: Apache-2.0 */
/* tree_query.h -- a compressed tree's value at one direction, without inverting the tree.
 *
 * HOT: no allocation, no lock, no libm. A query walks from the octant to the leaf once; cost
 * grows with the level, not with the size of the tree. The walk (which rows, with what factor)
 * and the sum over components are two functions, so that a caller that needs several ranges of
 * components, or trees of equal structure, walks once.
 *
 * Frame     as geodesic.h; z < 0 counts as 0. Trees of 2 octants fold y to |y|.
 * Threads   any number, on a constant Tree.
 */
#pragma once
#include "hemisphere/tree.h"

/* Continuous interpolation. Vertex tree: barycentric between the vertices around. Haar tree:
 * between its leaves; a leaf's centre keeps the leaf's value, each corner takes the area mean
 * of the leaves around it, linear in between (over the three triangles between centre and
 * corners, in barycentric coordinates). Reproduces constants. */
void tree_walk_interpolated(const Tree *tree, Vec3 direction, TreeTaps *taps);

/* Walk and sum of all components. */
void tree_interpolate(const Tree *tree, Vec3 direction, float *out);
