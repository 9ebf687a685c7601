/* SPDX-License-Identifier: Apache-2.0 */
/* tree.h -- a vector-valued function on the hemisphere as a compressed tree.
 *
 * Two bases stand behind one view: Haar trees (this header) and vertex trees (vertex_tree.h).
 * tree_open and tree_query.h take either; the blob's magic number distinguishes them. Here is
 * what both are made of; tree/haar_tree.h and tree/vertex_tree_build.h make them.
 *
 * A tree is one blob, little-endian, to be stored in a file. tree_open makes of it what
 * queries read (tree_query.h): of a Haar tree views into the blob, of a vertex tree rows in
 * the arena. A Haar row is the detail of one child
 * (tree/haar.h): `components` numbers.
 *
 * Blob      TreeHeader | octant means, float32 | scales, float32 (integer rows only) | nodes
 *           level by level | rows. Must lie at an address that is a multiple of 8.
 * Accuracy  the report compares with the source after everything, quantisation included.
 * Threads   a Tree is constant.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "hemisphere/geodesic.h"

#define TREE_MAX_COMPONENTS 256
#define TREE_MAGIC 0x52414148u /* "HAAR" */
#define TREE_VERSION 1u

typedef enum TreeRowFormat {
    TREE_ROWS_FLOAT = 0, /* float32 */
    TREE_ROWS_INT16 = 1  /* 16 bits times a scale for every level and component; 8 bits on the
                            finest levels where rounding to these is no more than 1/16 of what
                            the tree leaves out anyway */
} TreeRowFormat;

/* Errors are weighted by component_scale, over leaves. */
typedef struct TreeReport {
    uint32_t leaves;      /* leaves of the source */
    uint32_t stored_rows; /* octant means and details */
    size_t stored_values; /* numbers in these */
    uint32_t nodes;
    size_t bytes; /* of the blob */
    float max_error;
    float rms_error; /* area-weighted over the sphere's part, mean over components */
} TreeReport;

typedef struct TreeHeader {
    uint32_t magic, version;
    uint64_t size; /* bytes of the whole blob */
    uint8_t level, octants, weights, rows;
    uint32_t components;
    uint32_t node_count, row_count;                     /* row_count: details only */
    uint32_t means_offset, scales_offset, nodes_offset; /* bytes from the blob's start */
    uint32_t byte_level; /* rows of fathers of this level and finer have 8 bits; 0: none */
    uint64_t rows_offset;
} TreeHeader;

/* A triangle with details at or below it. The lowest 4 bits of children: which children have
 * a node; those nodes follow each other from index children >> 4. The lowest 3 bits of rows:
 * which of the children 1..3 have a row; from row index rows >> 3 on. Octant q is node q. */
typedef struct TreeNode {
    uint32_t children;
    uint32_t rows;
} TreeNode;

typedef enum TreeBasis { TREE_HAAR = 0, TREE_VERTEX = 1 } TreeBasis;

/* A checked blob, ready for queries. */
typedef struct Tree {
    const Geodesic *geodesic;
    TreeBasis basis;
    int level, octants, components;

    /* Vertex trees only (vertex_tree.h). */
    int base_level, level_count, plane_level;
    float base_factor;  /* 2^base_exponent */
    const float *scale; /* of each component, `stride` of them */
    const struct VertexLevel *levels;
    const struct VertexBlock *blocks; /* the first is empty */
    const uint8_t *depths;            /* levels with details around each cell of a depth level */
    const int16_t *numbers;           /* rows: of the base, then of the blocks */
    int stride;                       /* numbers from row to row, a multiple of 8 */

    /* Haar trees only. */
    const TreeNode *nodes;
    const float *means;  /* octants x components */
    const float *scales; /* level x components, integer rows only; else NULL */
    const void *rows;    /* 16-bit rows before 8-bit rows */
    bool has_area_weights;
    TreeRowFormat format;
    uint32_t row_count, node_count;
    uint32_t byte_row; /* the first row of 8 bits, row_count if there is none */
} Tree;

/* Three rows for each of the at most 11 triangles of a level around a leaf's two corners; one
 * more that is written before it is known whether it is kept. */
#define TREE_MAX_TAPS (3 * 11 * GEODESIC_MAX_LEVEL + 1)

/* A value as a weighted sum of a tree's octant means and rows. Of a vertex tree there are no
 * levels, and weights hold the powers of two that integers are multiplied by. */
typedef struct TreeTaps {
    int count;
    float mean_weight[4]; /* of the octant means */
    uint32_t row[TREE_MAX_TAPS];
    float weight[TREE_MAX_TAPS];
    uint8_t level[TREE_MAX_TAPS]; /* of the row's father, for the scales */
} TreeTaps;

/* Where a row of TREE_ROWS_INT16 starts, in bytes from tree->rows. */
static inline size_t tree_row_offset(const Tree *tree, uint32_t row) {
    size_t components = (size_t)tree->components;
    return row < tree->byte_row ? 2 * components * row
                                : components * ((size_t)tree->byte_row + row);
}
