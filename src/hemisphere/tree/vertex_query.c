/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/vertex_query.h"

#include "hemisphere/rows.h"
#include "hemisphere/tree/vertex.h"
#include "hemisphere/tree/vertex_tree.h"

/* The base level's three rows. */
static void put_base(const Tree *tree, VertexPlace place, TreeTaps *taps) {
    VertexLattice lattice = {tree->base_level, tree->octants};
    VertexPoint point = map_point(lattice, place);
    for (int i = 0; i < 3; i++) {
        taps->row[i] = point.vertex[i];
        taps->weight[i] = point.weight[i] * tree->base_factor;
    }
    taps->count = 3;
}

/* ---- one level of details ----------------------------------------------------------------
 *
 * Cells are counted from the level's first one, so that whole blocks are multiples of 4. */

/* The three edges of the triangle that holds a place: their cells, and their hat functions'
 * weights there. The edge along x and the diagonal lie in column x, the edge along y and the
 * diagonal in row y. */
typedef struct Edges {
    uint32_t x[3], y[3]; /* in order of the bits: along x, along y, diagonal */
    float weight[3];
} Edges;

static inline float least(float a, float b) {
    return a < b ? a : b;
}

/* A new vertex's hat function in a triangle whose corners have the coordinates a and b at the
 * edge's ends and c opposite: 2 b at a's end, 2 a at b's end, 1 - 2 c in the middle. */
static inline float hat(float a, float b, float c) {
    return 2 * least(least(a, b), 0.5f - c);
}

/* In the octant, the place lies in the cell (cx, cy), in its half towards the pole or the other
 * one; there (u, v, w) are the barycentric coordinates, u and v of the corners next to the
 * right angle. Mirrored, column cx is -1 - cx, and line cx is -cx. */
static inline Edges edges_at(const VertexLevel *level, VertexPlace place, int number) {
    float n = (float)(1 << number), x = place.x * n, y = place.y * n;
    int cx = (int)x, cy = (int)y;
    float u = x - (float)cx, v = y - (float)cy;
    int upper = u + v > 1;
    u = fabsf((float)upper - u); /* either half is as likely: no branch */
    v = fabsf((float)upper - v);
    float w = 1 - u - v, factor = level->factor;
    int mx = -(int)(place.octant & 1), my = -(int)(place.octant >> 1);
    uint32_t column = (uint32_t)((cx ^ mx) - level->x), row = (uint32_t)((cy ^ my) - level->y);
    uint32_t line_x = (uint32_t)(((cx + upper) ^ mx) - mx - level->x);
    uint32_t line_y = (uint32_t)(((cy + upper) ^ my) - my - level->y);
    return (Edges){{column, line_x, column},
                   {line_y, row, row},
                   {hat(u, w, v) * factor, hat(v, w, u) * factor, hat(u, v, w) * factor}};
}

/* The block of a cell; outside of the lattice the one that is empty. */
static inline const VertexBlock *find_block(const Tree *tree, const VertexLevel *level, uint32_t x,
                                            uint32_t y) {
    uint32_t bx = x / VERTEX_BLOCK_SIDE, by = y / VERTEX_BLOCK_SIDE;
    if (bx >= level->width || by >= level->height) return tree->blocks;
    return tree->blocks + level->block[by * level->width + bx];
}

/* Writes a tap for edge i, and counts it if there is such a detail: that cannot be predicted,
 * so there is no branch. */
static inline void put_detail(const VertexBlock *block, const Edges *e, uint32_t i,
                              TreeTaps *taps) {
    uint32_t bit = e->y[i] % VERTEX_BLOCK_SIDE * 12 + e->x[i] % VERTEX_BLOCK_SIDE * 3 + i;
    int at = taps->count;
    taps->row[at] = block->first + vertex_count_bits(block->bits & ((1ull << bit) - 1));
    taps->weight[at] = e->weight[i];
    taps->count = at + (int)((uint32_t)(block->bits >> bit) & (uint32_t)(e->weight[i] > 0));
}

static inline void put_in(const Tree *tree, const VertexLevel *level, const Edges *e, uint32_t i,
                          TreeTaps *taps) {
    const VertexBlock *block = find_block(tree, level, e->x[i], e->y[i]);
    if (block->bits) put_detail(block, e, i, taps);
}

/* Mostly the three edges are in one block. Written out, so that they stay in registers. */
static inline void put_level(const Tree *tree, const VertexLevel *level, VertexPlace place,
                             int number, TreeTaps *taps) {
    Edges e = edges_at(level, place, number);
    if (((e.x[0] ^ e.x[1]) | (e.y[0] ^ e.y[1])) < VERTEX_BLOCK_SIDE) {
        const VertexBlock *block = find_block(tree, level, e.x[0], e.y[1]);
        if (!block->bits) return;
        put_detail(block, &e, 0, taps);
        put_detail(block, &e, 1, taps);
        put_detail(block, &e, 2, taps);
    } else {
        put_in(tree, level, &e, 0, taps);
        put_in(tree, level, &e, 1, taps);
        put_in(tree, level, &e, 2, taps);
    }
}

/* ---- the walk ---------------------------------------------------------------------------- */

/* How many levels have details around a place. */
static inline int depth_at(const Tree *tree, VertexPlace place) {
    int side = 1 << VERTEX_DEPTH_LEVEL;
    int x = (int)(place.x * (float)side), y = (int)(place.y * (float)side);
    x = x < side ? x : side - 1;
    y = y < side ? y : side - 1;
    int cx = x ^ -(int)(place.octant & 1), cy = y ^ -(int)(place.octant >> 1);
    uint32_t at = (uint32_t)((cy + (tree->octants / 4) * side) * 2 * side + cx + side);
    return tree->depths[at];
}

static inline void walk(const Tree *tree, VertexPlace place, TreeTaps *taps) {
    put_base(tree, place, taps);
    for (int q = 0; q < 4; q++) taps->mean_weight[q] = 0;
    int depth = depth_at(tree, place);
    if (depth > tree->level - tree->base_level) depth = tree->level - tree->base_level;
    for (int l = 0; l < depth; l++)
        put_level(tree, &tree->levels[l], place, tree->base_level + l, taps);
}

void vertex_tree_walk_place(const Tree *tree, VertexPlace place, TreeTaps *taps) {
    walk(tree, place, taps);
}

void vertex_tree_walk(const Tree *tree, Vec3 direction, TreeTaps *taps) {
    VertexPlace place = map_place(tree->geodesic, tree->plane_level, direction);
    place.octant &= (uint32_t)tree->octants - 1; /* 2 octants: y is folded */
    walk(tree, place, taps);
}

/* ---- sums -------------------------------------------------------------------------------- */

/* Adds weight times eight numbers of a row. */
#ifdef __AVX2__
typedef struct Eight {
    Float8 all;
} Eight;

static inline void add_eight(Short8 numbers, float weight, Eight *sum) {
    sum->all += weight * __builtin_convertvector(numbers, Float8);
}
#else
typedef struct Eight {
    Float4 low, high;
} Eight;

static inline void add_eight(Short8 numbers, float weight, Eight *sum) {
    sum->low += weight * lower_shorts(numbers, 16);
    sum->high += weight * upper_shorts(numbers, 16);
}
#endif

/* 8 * eighths components, a constant where inlined, from `first` on. */
static inline void sum_eighths(const Tree *tree, const TreeTaps *taps, int first, int eighths,
                               float *out) {
    const int16_t *rows = tree->numbers + first;
    size_t stride = (size_t)tree->stride;
    Eight sum[4] = {0};
    for (int t = 0; t < taps->count; t++) {
        const int16_t *row = rows + taps->row[t] * stride;
        for (int e = 0; e < eighths; e++) {
            Short8 numbers;
            memcpy(&numbers, row + 8 * e, sizeof numbers);
            add_eight(numbers, taps->weight[t], &sum[e]);
        }
    }
    for (int e = 0; e < eighths; e++) {
        Eight scale;
        memcpy(&scale, tree->scale + first + 8 * e, sizeof scale);
#ifdef __AVX2__
        sum[e].all *= scale.all;
#else
        sum[e].low *= scale.low;
        sum[e].high *= scale.high;
#endif
        memcpy(out + 8 * e, &sum[e], sizeof sum[e]);
    }
}

/* The last few of eight one by one. */
void vertex_tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out) {
    float last[8];
    int i = 0, skipped = first % 8;
    if (skipped) {
        sum_eighths(tree, taps, first - skipped, 1, last);
        for (; i < count && skipped + i < 8; i++) out[i] = last[skipped + i];
    }
    for (; i + 32 <= count; i += 32) sum_eighths(tree, taps, first + i, 4, out + i);
    for (; i + 8 <= count; i += 8) sum_eighths(tree, taps, first + i, 1, out + i);
    if (i >= count) return;
    sum_eighths(tree, taps, first + i, 1, last);
    for (int k = 0; i + k < count; k++) out[i + k] = last[k];
}
