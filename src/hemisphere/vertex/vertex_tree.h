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
#include "hemisphere/vertex/vertex.h"

/* ---- the blob ----------------------------------------------------------------------------
 *
 * VertexHeader | scale, float32, one a component | VertexLevel, one a level of details |
 * directory words, uint32 | VertexFormat | directory ranks, uint16 | depths, 4 bits each |
 * formats of blocks, uint8 | zeros to a multiple of 8 | blocks, uint64 | rows |
 * VERTEX_TAIL zeros and zeros to a multiple of 8.
 *
 * Base      the values of all vertices of base_level, the first rows, in order of
 *           vertex_index, in format 0; times scale * 2^base_exponent.
 * Levels    l = 0, 1, ...: details of the vertices that are new on edges of level
 *           i = base_level + l. A new vertex (x, y), in steps of level i + 1, belongs to the
 *           cell (floor(x/2), floor(y/2)), as one of its three edges: 0 along x (y even), 1
 *           along y (x even), 2 the diagonal. 4 x 4 cells are a block: bit 12 row + 3 column +
 *           edge is set where there is a detail. The upper 16 bits, times 2^shift bytes after
 *           the level's first, are where the block's rows start; they follow in order of the
 *           bits. A directory word has a bit for each of 32 blocks of the level's window, row
 *           by row, that is not empty; its rank counts the level's blocks before the word.
 * Rows      of integers, times scale * 2^exponent. An integer is the sum of 16^p times the
 *           signed 4 bits of plane p = 0..3; plane p of a row has `pairs[p]` bytes, the first
 *           components in order, two a byte, the even one in the low bits; other components
 *           have 0 there. Most details are a few steps in the first components.
 * Depths    for each cell of depth_level, how many levels have details whose hat
 *           reaches into it: where queries stop.
 */
#define VERTEX_MAGIC 0x58545256u /* "VRTX" */
#define VERTEX_VERSION 1u
#define VERTEX_MAX_DEPTH_LEVEL 4
#define VERTEX_MAX_BASE_LEVEL 4
#define VERTEX_BLOCK_SIDE 4 /* cells */
#define VERTEX_BLOCK_BITS 48
#define VERTEX_PLANES 4
#define VERTEX_LEAST (-30000) /* integers that planes can hold */
#define VERTEX_MOST 30000
#define VERTEX_TAIL 16 /* bytes that a query may read beyond a row */
#define VERTEX_MAX_SCALE 1e20f
#define VERTEX_MAX_EXPONENT 24
#define VERTEX_MAX_SHIFT 8

typedef struct VertexHeader {
    uint32_t magic;
    uint16_t version, components;
    uint64_t size; /* bytes of the whole blob */
    uint8_t level, octants, base_level, level_count, depth_level, format_count;
    int8_t base_exponent;
    uint8_t zero;
    uint16_t word_count, block_count; /* of all levels */
    uint32_t row_bytes;               /* of the base and all levels */
} VertexHeader;

typedef struct VertexLevel {
    int16_t x, y;          /* first cell of the window */
    uint8_t width, height; /* of the window in blocks */
    uint8_t shift;
    int8_t exponent;
    uint16_t first_word, first_block;
    uint32_t first_byte; /* of the level's rows */
} VertexLevel;

/* How a row is packed: bytes of each plane, never more than of the plane before. */
typedef struct VertexFormat {
    uint8_t pairs[VERTEX_PLANES];
} VertexFormat;

static inline uint32_t vertex_format_bytes(VertexFormat f) {
    return (uint32_t)f.pairs[0] + f.pairs[1] + f.pairs[2] + f.pairs[3];
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
