/* vertex_tree.h -- compresses a vector-valued function on the hemisphere in the vertex basis.
 *
 * A vertex of level i+1 is new on an edge (u, w) of level i; its detail is f(v) - (f(u)+f(w))/2.
 * What a query reconstructs is the barycentric interpolation on the finest triangles:
 * continuous, and between the values of its vertices everywhere. Coded in a closed loop from
 * the top: every vertex is predicted from RECONSTRUCTED ends, and a detail is stored only where
 * the prediction is not accepted, so that no error adds up over levels.
 *
 * The blob is opened by tree_open and read by tree_query.h like a Haar tree's; its magic number
 * says which one it is.
 */
#pragma once
#include "hemisphere/tree.h"
#include "hemisphere/vertex.h"

/* Is this reconstruction of a vertex good enough? reconstructed: `components` numbers. A
 * function of its arguments only. */
typedef bool VertexAccepts(const void *context, uint32_t vertex, const float *reconstructed);

typedef struct VertexTreeOptions {
    VertexLattice  lattice;    /* of the values */
    int            components; /* 1..TREE_MAX_COMPONENTS */
    VertexAccepts *accepts;
    const void    *context;
    /* What one component's rounding may cost in its own unit, where that matters beyond
     * `accepts`: the coarsest step that the coder may use; NULL: it chooses. */
    const float   *coarsest_step;
} VertexTreeOptions;

/* values: vertex_count(lattice) x components, finite. Fails (ERROR_INPUT) on values that are not
 * finite, and when a stored value cannot be made acceptable (named by its direction). The
 * report's errors are over vertices, every component by itself; leaves counts vertices. */
bool vertex_tree_build(const VertexTreeOptions *options, const float *values, Arena *arena,
                       const void **blob, TreeReport *report, Error *err);

/* The tree's function at the vertices of its lattice: vertex_count x components floats. */
void vertex_tree_expand(const Tree *tree, float *values);

/* ---- the blob ----------------------------------------------------------------------------
 *
 * VertexHeader | scale, float32, one a component | VertexLevel, one a level of details |
 * directory: uint32 bits, then uint16 ranks | depths, 4 bits each | blocks, uint64 |
 * base rows, int16 | rows | VERTEX_TAIL zeros. Each part starts at a multiple of its numbers'
 * size.
 *
 * Base      the values of all vertices of base_level, times scale * 2^base_exponent.
 * Levels    l = 0, 1, ...: details of the vertices that are new on edges of level
 *           i = base_level + l. A new vertex (x, y), in steps of level i + 1, belongs to the
 *           cell (floor(x/2), floor(y/2)), as one of its three edges: 0 along x (y even), 1
 *           along y (x even), 2 the diagonal. 4 x 4 cells are a block: bit 12 row + 3 column +
 *           edge says that there is a detail, the upper 16 bits count the level's rows before.
 *           A directory word has a bit for each of 32 blocks of the level's window, row by row,
 *           that is not empty; its rank counts the level's blocks before the word.
 * Rows      of a level: the first `kept` components, 8 or 16 bits each; times scale *
 *           2^exponent.
 * Depths    for each cell of level VERTEX_DEPTH_LEVEL, how many levels have details whose hat
 *           reaches into it or beyond it on the way down: where queries stop.
 */
#define VERTEX_MAGIC 0x58545256u /* "VRTX" */
#define VERTEX_VERSION 1u
#define VERTEX_DEPTH_LEVEL 3
#define VERTEX_MAX_BASE_LEVEL 4
#define VERTEX_BLOCK_SIDE 4 /* cells */
#define VERTEX_BLOCK_BITS 48
#define VERTEX_TAIL 16 /* bytes that a query may read beyond a row */
#define VERTEX_MAX_SCALE 1e20f
#define VERTEX_MAX_EXPONENT 24

typedef struct VertexHeader {
    uint32_t magic, version;
    uint64_t size; /* bytes of the whole blob */
    uint8_t  level, octants, base_level, level_count;
    uint16_t components, word_count; /* directory words of all levels */
    uint16_t block_count;            /* of all levels */
    int16_t  base_exponent;
    uint32_t row_bytes;
} VertexHeader;

typedef struct VertexLevel {
    int16_t  x, y;             /* first cell of the window */
    uint8_t  width, height;    /* of the window in blocks */
    uint8_t  is_wide;          /* rows of 16 bits */
    int8_t   exponent;
    uint16_t first_word, first_block;
    uint32_t first_byte; /* of the level's rows */
    uint16_t kept;       /* components of a row */
    uint16_t row_bytes;
} VertexLevel;

/* Bits that are set; exact whether the instruction set counts them or not. */
static inline uint32_t vertex_count_bits(uint64_t bits)
{
#ifdef __POPCNT__
    return (uint32_t)__builtin_popcountll(bits);
#else
    bits -= bits >> 1 & 0x5555555555555555u;
    bits = (bits & 0x3333333333333333u) + (bits >> 2 & 0x3333333333333333u);
    bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (uint32_t)(bits * 0x0101010101010101u >> 56);
#endif
}
