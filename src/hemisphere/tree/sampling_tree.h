/* SPDX-License-Identifier: Apache-2.0 */
/* sampling_tree.h -- chooses directions in proportion to functions on the hemisphere.
 *
 * A pruned tree over the triangles of geodesic.h: cells of different size, constant density in
 * each. Several functions (incidences of one panel) share the cells and have densities of their
 * own. Sampling descends by conditional probabilities, two binary choices a level, each of
 * which hands the unused part of its random number on (Clarberg et al. 2005, "Wavelet
 * Importance Sampling"), so that well-spread pairs of numbers give well-spread directions;
 * inside the cell the direction is uniform (geodesic_sampler_draw).
 *
 * Units     density per solid angle of the frame that the tree was built in, sr^-1.
 * Blob      little-endian bits: a header, which triangles are split (in depth first order),
 *           then every function's probabilities, in steps of SAMPLING_STEPS and as differences
 *           to those of the function before (Rice's code). Densities are derived from the very
 *           probabilities that sampling compares with.
 * Memory    opening expands the blob into the arena: 64 bytes a cell, 8 a cell and function.
 * Threads   constant after opening. Sampling and pdf are HOT: no allocation, no libm.
 */
#pragma once
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"
#include "hemisphere/geodesic.h"

#define SAMPLING_MAGIC 0x504d4153u /* "SAMP" */
#define SAMPLING_VERSION 2u
#define SAMPLING_FUNCTIONS_MAX 1024
#define SAMPLING_CELLS_MAX 16384
#define SAMPLING_STEPS 127 /* probability of step i: x^2 (3 - 2 x), x = i / SAMPLING_STEPS */

typedef struct SamplingHeader {
    uint32_t magic;
    uint8_t version, level, octants, reserved;
    uint16_t functions, splits; /* split triangles: cells are octants + 3 * splits */
    uint32_t size;              /* bytes, this header included */
} SamplingHeader;

/* How a node, one of four triangles' father or the hemisphere with its octants, is left. */
typedef struct SamplingChoice {
    float pair;      /* probability of children 0, 1 against 2, 3: u0 < pair */
    float inside[2]; /* probability of the first of each pair: u1 < inside */
} SamplingChoice;

/* Node 0 chooses the octant; nodes and cells are numbered as a walk in depth meets them. With
 * 2 stored octants children 2, 3 of node 0 are children 0, 1 again, seen in the mirror. */
typedef struct SamplingNode {
    uint32_t child[4]; /* node index, or SAMPLING_CELL | cell index */
} SamplingNode;
#define SAMPLING_CELL 0x80000000u

typedef struct SamplingTree {
    const Geodesic *geodesic;
    const SamplingNode *nodes;
    const SamplingChoice *choices; /* [function][node] */
    const GeodesicSampler *cells;
    const float *density; /* [cell][function], sr^-1, over all 4 octants */
    int level, octants, functions;
    uint32_t node_count, cell_count;
} SamplingTree;

/* Which functions are mixed; weights at least 0, their sum 1. */
#define SAMPLING_MIX_MAX 4
typedef struct SamplingMix {
    int count;
    int function[SAMPLING_MIX_MAX];
    float weight[SAMPLING_MIX_MAX];
} SamplingMix;

typedef struct SamplingResult {
    Vec3 direction; /* unit */
    float pdf;      /* sr^-1; what sampling_tree_pdf gives for this direction, bit for bit */
    float margin;   /* how far inside its cell: least barycentric weight, 0 on an edge */
} SamplingResult;

/* u in [0, 1)^3; u[2] chooses the function. */
SamplingResult sampling_tree_sample(const SamplingTree *tree, const SamplingMix *mix,
                                    const float u[3]);

/* Density with which sampling_tree_sample chooses a direction; 0 for z < 0. Integrates to 1. */
float sampling_tree_pdf(const SamplingTree *tree, const SamplingMix *mix, Vec3 direction);
