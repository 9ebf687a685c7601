/* sampling_tree.h -- chooses directions in proportion to a function on the hemisphere.
 *
 * A pruned tree over the triangles of geodesic.h: cells of different size, constant density in
 * each. Sampling descends by conditional probabilities, two binary choices a level, each of
 * which hands the unused part of its random number on (Clarberg et al. 2005, "Wavelet
 * Importance Sampling"), so that well-spread pairs of numbers give well-spread directions;
 * inside the cell the direction is uniform (geodesic_sample_triangle).
 *
 * Units     density per solid angle of the frame that the tree was built in, sr^-1.
 * Blob      little-endian, offsets only; at an address that is a multiple of 8.
 * Threads   constant after opening. Sampling and pdf are HOT: no allocation, no libm.
 */
#pragma once
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"
#include "hemisphere/geodesic.h"

typedef struct SamplingOptions {
    int   level;   /* of the leaf integrals */
    int   octants; /* 4, or 2: mirror-symmetric in y, sampled over all 4 */
    int   cells;   /* at most this many cells (of the octants stored), at least `octants` */
    float uniform_share; /* part of the samples that ignores the function, [0, 1]: makes the
                            density positive everywhere; 0: only where the integral is */
} SamplingOptions;

#define SAMPLING_MAGIC 0x504d4153u /* "SAMP" */
#define SAMPLING_VERSION 1u

typedef struct SamplingHeader {
    uint32_t magic, version;
    uint64_t size;
    uint8_t  level, octants, reserved[2];
    uint32_t node_count, cell_count;
    uint32_t nodes_offset, cells_offset;
    uint32_t reserved_too;
} SamplingHeader;

/* Four triangles to choose from: the octants (node 0), or the children of one triangle. Nodes
 * and cells are numbered as a walk in depth meets them; with 2 stored octants children 2, 3 of
 * node 0 are children 0, 1 again. */
typedef struct SamplingNode {
    float    pair;      /* probability of children 0, 1 against 2, 3: u0 < pair */
    float    inside[2]; /* probability of the first of each pair: u1 < inside */
    uint32_t child[4];  /* node index, or SAMPLING_CELL | cell index */
} SamplingNode;
#define SAMPLING_CELL 0x80000000u

typedef struct SamplingTree {
    const Geodesic     *geodesic;
    const SamplingNode *nodes;   /* node 0 chooses the octant */
    const float        *density; /* per cell, sr^-1, over all 4 octants */
    int                 level, octants;
    uint32_t            node_count, cell_count;
} SamplingTree;

typedef struct SamplingResult {
    Vec3  direction; /* unit */
    float pdf;       /* sr^-1; what sampling_tree_pdf gives for this direction, bit for bit */
} SamplingResult;

/* integrals: octants * 4^level values >= 0, the function's integral over each leaf (f * cos *
 * Jacobian * area). Splits the cells whose square root varies most until `cells` are there.
 * Fails (ERROR_INPUT) on negative or non-finite values and when all are 0. */
bool sampling_tree_build(const SamplingOptions *options, const float *integrals, Arena *arena,
                         const void **blob, Error *err);

/* Bytes of a blob that sampling_tree_build made. */
size_t sampling_tree_size(const void *blob);

/* Checks everything that queries rely on, probabilities included, and makes the view. */
bool sampling_tree_open(const void *blob, size_t size, const Geodesic *geodesic,
                        SamplingTree *out, Error *err);

/* u0, u1 in [0, 1). */
SamplingResult sampling_tree_sample(const SamplingTree *tree, float u0, float u1);

/* Density with which sampling_tree_sample chooses a direction; 0 for z < 0. Integrates to 1. */
float sampling_tree_pdf(const SamplingTree *tree, Vec3 direction);
