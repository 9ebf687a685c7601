/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/vertex_open.h"

#include <math.h>
#include <string.h>

#include "hemisphere/tree/vertex_code.h"
#include "hemisphere/tree/vertex_query.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "blobs are little-endian in place");
_Static_assert(sizeof(VertexHeader) == 32, "the blob's layout");

/* ---- checks ------------------------------------------------------------------------------ */

static bool refuse(Error *err, const char *what, double found, double wanted) {
    return error_set(err, ERROR_INPUT, "vertex tree: %s is %.9g, required: %.9g", what, found,
                     wanted);
}

static bool check_header(const VertexHeader *h, size_t size, Error *err) {
    if (h->version != VERTEX_VERSION) return refuse(err, "version", h->version, VERTEX_VERSION);
    if (h->size != size)
        return error_set(err, ERROR_INPUT, "vertex tree: %zu bytes are there, required: %llu", size,
                         (unsigned long long)h->size);
    if (h->level >= GEODESIC_MAX_LEVEL)
        return refuse(err, "level", h->level, GEODESIC_MAX_LEVEL - 1);
    if (h->octants != 2 && h->octants != 4) return refuse(err, "octant count", h->octants, 4);
    if (h->base_level > h->level || h->base_level > VERTEX_MAX_BASE_LEVEL)
        return refuse(err, "base level", h->base_level, VERTEX_MAX_BASE_LEVEL);
    if (h->level_count > h->level - h->base_level)
        return refuse(err, "number of levels", h->level_count, h->level - h->base_level);
    if (h->components < 1 || h->components > TREE_MAX_COMPONENTS)
        return refuse(err, "component count", h->components, TREE_MAX_COMPONENTS);
    for (size_t i = 0; i < sizeof h->zero; i++)
        if (h->zero[i]) return refuse(err, "spare byte", h->zero[i], 0);
    uint32_t base = vertex_count((VertexLattice){h->base_level, h->octants});
    uint32_t all = vertex_count((VertexLattice){h->level, h->octants});
    if (h->row_count < base || h->row_count > all)
        return refuse(err, "row count", h->row_count, base);
    return size >= vertex_front_bytes(h) ||
           refuse(err, "number of bytes", (double)size, (double)vertex_front_bytes(h));
}

/* Any integer times these is finite. */
static bool check_factors(const VertexHeader *h, Error *err) {
    const float *scale = (const float *)(const void *)(h + 1);
    const int8_t *exponent = (const int8_t *)(const void *)(scale + h->components);
    for (int c = 0; c < h->components; c++)
        if (!(fabsf(scale[c]) <= VERTEX_MAX_SCALE))
            return error_set(err, ERROR_INPUT,
                             "vertex tree: scale %d is %g, required: a number within %g", c,
                             (double)scale[c], (double)VERTEX_MAX_SCALE);
    for (int l = -1; l < h->level_count; l++) {
        int of = l < 0 ? h->base_exponent : exponent[l];
        if (of < -VERTEX_MAX_EXPONENT || of > VERTEX_MAX_EXPONENT)
            return refuse(err, "exponent", of, 0);
    }
    return true;
}

/* ---- the directory ----------------------------------------------------------------------- */

/* A tree while its rows are put in order. */
typedef struct Directory {
    Tree *tree;
    const VertexRows *rows; /* in the order of the bits */
    VertexBlock *blocks;
    uint32_t block_count, row_count; /* so far */
    uint8_t *depths;
    int16_t *numbers;
} Directory;

static uint32_t stored_edges(const Directory *d, int level, VertexEdge *edges) {
    VertexLattice lattice = {d->tree->level, d->tree->octants};
    uint32_t all = vertex_edges(lattice, level, edges), count = 0;
    for (uint32_t i = 0; i < all; i++)
        if (d->rows->stored[edges[i].vertex]) edges[count++] = edges[i];
    return count;
}

/* The depth level's cells that a detail's two triangles may touch. */
static void mark_depth(Directory *d, const VertexEdge *edge, int half, int depth) {
    int n = 1 << d->tree->level, side = 1 << VERTEX_DEPTH_LEVEL;
    int low = d->tree->octants == 2 ? 0 : -side;
    for (int cy = low; cy < side; cy++)
        for (int cx = -side; cx < side; cx++) {
            bool apart =
                (cx + 1) * n <= (edge->x - half) * side || cx * n >= (edge->x + half) * side ||
                (cy + 1) * n <= (edge->y - half) * side || cy * n >= (edge->y + half) * side;
            uint8_t *at = &d->depths[(cy - low) * 2 * side + cx + side];
            if (!apart && *at < depth) *at = (uint8_t)depth;
        }
}

/* A level without details yet. */
static VertexLevel empty_level(const VertexHeader *h, int l, Arena *arena) {
    const int8_t *exponent = (const int8_t *)(h + 1) + sizeof(float) * h->components;
    int side = 1 << (h->base_level + l), low = h->octants == 2 ? 0 : -side;
    VertexLevel level = {.x = -side, .y = low, .factor = ldexpf(1, exponent[l])};
    level.width = (uint32_t)(2 * side + VERTEX_BLOCK_SIDE - 1) / VERTEX_BLOCK_SIDE;
    level.height = (uint32_t)(side - low + VERTEX_BLOCK_SIDE - 1) / VERTEX_BLOCK_SIDE;
    level.block = ARENA_NEW(arena, uint16_t, level.width *level.height);
    return level;
}

/* Blocks of a level, and its rows in their order. */
static void put_level(Directory *d, int l, Arena scratch) {
    const Tree *tree = d->tree;
    const VertexLevel *level = &tree->levels[l];
    int number = tree->base_level + l, shift = tree->level - number;
    VertexLattice lattice = {tree->level, tree->octants};
    VertexEdge *edges = ARENA_NEW(&scratch, VertexEdge, vertex_edges(lattice, number, NULL));
    uint32_t count = stored_edges(d, number, edges), from = d->row_count;
    uint16_t *block = (uint16_t *)level->block;
    uint32_t *at = ARENA_NEW(&scratch, uint32_t, count),
             *bit = ARENA_NEW(&scratch, uint32_t, count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t x = (uint32_t)((edges[i].x >> shift) - level->x);
        uint32_t y = (uint32_t)((edges[i].y >> shift) - level->y);
        at[i] = y / VERTEX_BLOCK_SIDE * level->width + x / VERTEX_BLOCK_SIDE;
        bit[i] = y % VERTEX_BLOCK_SIDE * 12 + x % VERTEX_BLOCK_SIDE * 3 + edges[i].cell_edge;
        if (!block[at[i]]) block[at[i]] = (uint16_t)d->block_count++;
        d->blocks[block[at[i]]].bits |= 1ull << bit[i];
        mark_depth(d, &edges[i], 1 << (shift - 1), l + 1);
    }
    for (uint32_t b = 0; b < level->width * level->height; b++)
        if (block[b]) {
            d->blocks[block[b]].first = d->row_count;
            d->row_count += vertex_count_bits(d->blocks[block[b]].bits);
        }
    for (uint32_t i = 0; i < count; i++) {
        const VertexBlock *of = &d->blocks[block[at[i]]];
        size_t row = of->first + vertex_count_bits(of->bits & ((1ull << bit[i]) - 1));
        memcpy(d->numbers + row * (size_t)tree->stride,
               d->rows->numbers + (size_t)(from + i) * (size_t)tree->stride,
               sizeof *d->numbers * (size_t)tree->stride);
    }
}

bool vertex_tree_open(const void *blob, size_t size, const Geodesic *geodesic, Arena *arena,
                      Tree *out, Error *err) {
    const VertexHeader *h = blob;
    if (size < sizeof *h) return refuse(err, "number of bytes", (double)size, sizeof *h);
    if (!check_header(h, size, err) || !check_factors(h, err)) return false;
    if (geodesic->level < vertex_plane_level(h->level))
        return refuse(err, "level of the geodesic", geodesic->level, vertex_plane_level(h->level));
    size_t stride = (h->components + 7u) / 8 * 8;
    uint32_t base = vertex_count((VertexLattice){h->base_level, h->octants});
    float *scale = ARENA_NEW(arena, float, stride);
    VertexLevel *levels = ARENA_NEW(arena, VertexLevel, h->level_count);
    VertexRows rows;
    Tree tree = {.geodesic = geodesic,
                 .basis = TREE_VERTEX,
                 .level = h->level,
                 .octants = h->octants,
                 .components = h->components,
                 .base_level = h->base_level,
                 .level_count = h->level_count,
                 .plane_level = vertex_plane_level(h->level),
                 .base_factor = ldexpf(1, h->base_exponent),
                 .scale = scale,
                 .levels = levels,
                 .stride = (int)stride};
    Directory d = {
        .tree = &tree,
        .rows = &rows,
        .blocks = ARENA_NEW(arena, VertexBlock, h->row_count - base + 1),
        .block_count = 1,
        .row_count = base,
        .depths = ARENA_NEW(arena, uint8_t, vertex_depth_cells(h->octants)),
        .numbers = arena_alloc(arena, sizeof(int16_t), VERTEX_LINE_BYTES, h->row_count * stride)};
    tree.blocks = d.blocks;
    tree.depths = d.depths;
    tree.numbers = d.numbers;
    memcpy(scale, h + 1, sizeof *scale * h->components);
    for (int l = 0; l < h->level_count; l++) levels[l] = empty_level(h, l, arena);
    Arena scratch = *arena;
    if (!vertex_decode(h, &scratch, &rows))
        return error_set(err, ERROR_INPUT, "vertex tree: its bits hold another number of rows");
    memcpy(d.numbers, rows.numbers, sizeof *d.numbers * base * stride);
    for (int l = 0; l < h->level_count; l++) put_level(&d, l, scratch);
    *out = tree;
    return true;
}

/* ---- expansion --------------------------------------------------------------------------- */

void vertex_tree_expand(const Tree *tree, float *values) {
    vertex_tree_expand_level(tree, tree->level, values);
}

void vertex_tree_expand_level(const Tree *tree, int level, float *values) {
    VertexLattice lattice = {level, tree->octants};
    int n = 1 << level;
    for (int y = tree->octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = (y < 0 ? -y : y) - n; x <= n - (y < 0 ? -y : y); x++) {
            VertexPlace place = {(float)(x < 0 ? -x : x) / (float)n,
                                 (float)(y < 0 ? -y : y) / (float)n,
                                 (x < 0 ? 1u : 0u) | (y < 0 ? 2u : 0u)};
            TreeTaps taps;
            vertex_tree_walk_place(tree, place, &taps);
            vertex_tree_sum(tree, &taps, 0, tree->components,
                            values + vertex_index(lattice, x, y) * (size_t)tree->components);
        }
}
