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

/* Three rows for each of the at most 11 triangles of a level around a leaf's two corners; one
 * more that is written before it is known whether it is kept. */
#define TREE_MAX_TAPS (3 * 11 * GEODESIC_MAX_LEVEL + 1)

/* A value as a weighted sum of a tree's octant means and rows. Of a vertex tree: the rows are
 * places in bytes, levels are formats, and weights hold the powers of two that integers are
 * multiplied by. */
typedef struct TreeTaps {
    int      count;
    float    mean_weight[4]; /* of the octant means */
    uint32_t row[TREE_MAX_TAPS];
    float    weight[TREE_MAX_TAPS];
    uint8_t  level[TREE_MAX_TAPS]; /* of the row's father, for the scales */
} TreeTaps;

/* The mean over the triangle of `level` around the direction (level of detail); level =
 * tree->level is the leaf's value. With area weights it is the exact mean of the tree. A vertex
 * tree has no means: it answers with the interpolation between the vertices of `level` (of its
 * base level at least), which is smooth too but filters nothing; at level = tree->level that is
 * the value. */
void tree_walk_mean(const Tree *tree, int level, Vec3 direction, TreeTaps *taps);

/* The same for a triangle's id (of 2-octant trees: ids of octants 2, 3 are folded; of vertex
 * trees: at its centre). */
void tree_walk_triangle(const Tree *tree, int level, uint32_t id, TreeTaps *taps);

/* Continuous interpolation. Of a vertex tree: barycentric between the vertices around. Of a
 * Haar tree, between its leaves: a leaf's centre keeps the leaf's value, each corner
 * takes the area mean of the leaves around it, linear in between (over the three triangles
 * between centre and corners, in barycentric coordinates). Reproduces constants. */
void tree_walk_interpolated(const Tree *tree, Vec3 direction, TreeTaps *taps);

/* out[i] = component first + i, 0 <= i < count. */
void tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out);

/* Walk and sum of all components. */
void tree_mean(const Tree *tree, int level, Vec3 direction, float *out);
void tree_interpolate(const Tree *tree, Vec3 direction, float *out);

/* The leaf's value. */
static inline void tree_value(const Tree *tree, Vec3 direction, float *out)
{
    tree_mean(tree, tree->level, direction, out);
}
