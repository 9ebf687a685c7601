/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_tree.h -- a vector-valued function on the hemisphere compressed in the vertex basis.
 *
 * A vertex of level i+1 is new on an edge (u, w) of level i; its detail is
 * f(v) - (f(u) + f(w))/2. What a query reconstructs is the barycentric interpolation on the
 * finest triangles: continuous, and between the values of its vertices everywhere. Which
 * details are stored, and towards which values, is chosen for the whole function
 * (vertex_choose.c); then they are coded in a closed loop from the top: every vertex is
 * predicted from RECONSTRUCTED ends, and one whose prediction is not accepted gets a detail
 * too, so that no error adds up over levels.
 *
 * The blob is opened by tree_open and read by tree_query.h like a Haar tree's; its magic number
 * distinguishes them.
 */
#pragma once
#include "hemisphere/tree.h"
#include "hemisphere/tree/vertex.h"

/* ---- the blob ----------------------------------------------------------------------------
 *
 * VertexHeader | scale, float32, one a component | exponent, int8, one a level of details |
 * coded bits, zeros to a multiple of 8.
 *
 * Base      the values of all vertices of base_level, in order of vertex_index: integers times
 *           scale * 2^base_exponent.
 * Levels    l = 0, 1, ...: details of the vertices that are new on edges of level
 *           base_level + l: integers times scale * 2^exponent.
 * Bits      of an arithmetic coder, each with a probability that follows the bits before it in
 *           the same context (vertex_code.c): the base's integers less those before them, row
 *           by row; then for every edge of every level whether it has a detail, and its
 *           integers. Most details are a few steps in the first components.
 */
#define VERTEX_MAGIC 0x58545256u /* "VRTX" */
#define VERTEX_VERSION 2u
#define VERTEX_MAX_BASE_LEVEL 4
#define VERTEX_LEAST (-30000) /* integers that are stored */
#define VERTEX_MOST 30000
#define VERTEX_MAX_SCALE 1e20f
#define VERTEX_MAX_EXPONENT 24

typedef struct VertexHeader {
    uint32_t magic;
    uint16_t version, components;
    uint64_t size; /* bytes of the whole blob */
    uint8_t level, octants, base_level, level_count;
    uint32_t row_count; /* of the base and all details */
    int8_t base_exponent;
    uint8_t zero[7];
} VertexHeader;

/* Bytes in front of the coded bits. */
static inline size_t vertex_front_bytes(const VertexHeader *h) {
    return sizeof *h + sizeof(float) * h->components + h->level_count;
}

/* ---- what queries read (vertex_open.c makes it) -------------------------------------------
 *
 * A new vertex (x, y) of a level, in steps of half its cells, belongs to the cell (floor(x/2),
 * floor(y/2)), as one of its three edges: 0 along x (y even), 1 along y (x even), 2 the
 * diagonal. 4 x 4 cells are a block: bit 12 row + 3 column + edge is set where there is a
 * detail; rows of a block follow each other in order of the bits. */
#define VERTEX_BLOCK_SIDE 4 /* cells */
#define VERTEX_BLOCK_BITS 48
#define VERTEX_DEPTH_LEVEL 4
#define VERTEX_LINE_BYTES 64 /* rows of 32 numbers touch one */

typedef struct VertexBlock {
    uint64_t bits;
    uint32_t first; /* row */
} VertexBlock;

typedef struct VertexLevel {
    const uint16_t *block;  /* of each 4 x 4 cells, row by row; 0: one without a detail */
    int x, y;               /* the first cell */
    uint32_t width, height; /* in blocks */
    float factor;           /* 2^exponent */
} VertexLevel;

/* Cells of the depth level: of the square around the lattice's plane, or of its half. */
static inline size_t vertex_depth_cells(int octants) {
    return (size_t)octants << 2 * VERTEX_DEPTH_LEVEL;
}

/* Bits that are set; exact whether the instruction set counts them or not. */
static inline uint32_t vertex_count_bits(uint64_t bits) {
#ifdef __POPCNT__
    return (uint32_t)__builtin_popcountll(bits);
#else
    bits -= bits >> 1 & 0x5555555555555555u;
    bits = (bits & 0x3333333333333333u) + (bits >> 2 & 0x3333333333333333u);
    bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (uint32_t)(bits * 0x0101010101010101u >> 56);
#endif
}

/* ---- how a function is to be compressed; `accepts` is called by up to `threads` threads -- */

/* Is this reconstruction of a vertex good enough? reconstructed: `components` numbers. A
 * function of its arguments only. */
typedef bool VertexAccepts(const void *context, uint32_t vertex, const float *reconstructed);

typedef struct VertexTreeOptions {
    VertexLattice lattice; /* of the values */
    int components;        /* 1..TREE_MAX_COMPONENTS; the largest first pack best */
    VertexAccepts *accepts;
    const void *context;
    /* The coarsest step that the coder may use for each component, in its own unit, where
     * that matters beyond `accepts`; NULL: it chooses. */
    const float *coarsest_step;
    int threads; /* 0 and 1: the caller's alone; the bytes do not depend on it */
} VertexTreeOptions;
