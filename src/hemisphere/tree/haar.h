/* SPDX-License-Identifier: Apache-2.0 */
/* haar.h -- the Haar-like wavelet transform on the triangles of the hemisphere.
 *
 * The transform of the ELDIM paper: a father's mean m replaces the value of its central child
 * (place 0), the three corner children keep their details d_i = c_i - m. Nothing is lost:
 *   equal weights  m = (c_0 + c_1 + c_2 + c_3) / 4,     c_0 = m - (d_1 + d_2 + d_3)
 *   area weights   m = sum a_i c_i / sum a_i,           c_0 = m - (a_1 d_1 + ...) / a_0
 * and c_i = m + d_i. With area weights every mean is the exact integral mean of its triangle.
 *
 * Layout    values[(leaf * components) + component]; after the transform the mean of octant q
 *           stands at leaf q * 4^level, and the detail of child k = 1..3 of node n of level j
 *           at leaf (4n + k) * 4^(level-j-1).
 * Memory    in place; `scratch` needs about 11 bytes for every leaf of one octant.
 * Threads   nothing is shared.
 */
#pragma once
#include "base/arena.h"
#include "hemisphere/geodesic.h"

typedef enum HaarWeights { HAAR_EQUAL = 0, HAAR_AREA = 1 } HaarWeights;

typedef struct HaarShape {
    int level;      /* of the leaves, 0..GEODESIC_MAX_LEVEL */
    int octants;    /* 4, or 2 for functions that are mirror-symmetric in y */
    int components; /* values per leaf, at least 1 */
    HaarWeights weights;
} HaarShape;

/* Leaves of a shape: octants * 4^level. */
static inline uint32_t haar_leaf_count(const HaarShape *shape) {
    return (uint32_t)shape->octants << 2 * shape->level;
}

/* Leaf values to octant means and details, in place. */
void haar_forward(const HaarShape *shape, float *values, Arena scratch);

/* The exact inverse (to rounding, 1e-6 of the largest value). */
void haar_inverse(const HaarShape *shape, float *values, Arena scratch);

/* norms[leaf]: by what the coefficient at a leaf's place must be multiplied so that its square
 * is the square integral (sr) that vanishes with it: sqrt(a_i + a_i^2 / a_0) for the detail of
 * child i, sqrt(area) for octant means. With equal weights c_0 takes the opposite change in
 * full: sqrt(a_i + a_0). norms: haar_leaf_count floats. */
void haar_norms(const HaarShape *shape, float *norms, Arena scratch);
