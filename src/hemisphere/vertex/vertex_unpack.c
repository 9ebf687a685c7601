/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/vertex/vertex_unpack.h"

#include <math.h>

#include "hemisphere/vertex/vertex.h"
#include "hemisphere/vertex/vertex_open.h"

#define LINE_BYTES 64 /* rows of 32 numbers touch one */

static uint32_t rows_of_block(const Tree *tree, uint32_t block) {
    return vertex_count_bits(tree->blocks[block] & ((1ull << VERTEX_BLOCK_BITS) - 1));
}

/* Signed 4 bits times 16^plane, modulo 2^16 like the packed sums. */
static void unpack_row(const uint8_t *from, VertexFormat format, int16_t *to) {
    for (int p = 0; p < VERTEX_PLANES; from += format.pairs[p++])
        for (int i = 0; i < 2 * format.pairs[p]; i++) {
            int digit = from[i / 2] >> 4 * (i % 2) & 15;
            int value = ((digit ^ 8) - 8) * (1 << 4 * p);
            to[i] = (int16_t)(uint16_t)(to[i] + value);
        }
}

/* Returns where the next row goes. */
static int16_t *unpack_rows(const Tree *tree, uint32_t byte, VertexFormat format, uint32_t count,
                            int16_t *to) {
    for (uint32_t i = 0; i < count; i++, to += tree->unpacked_stride)
        unpack_row(tree->details + byte + i * vertex_format_bytes(format), format, to);
    return to;
}

void vertex_tree_unpack(Tree *tree, Arena *arena) {
    uint32_t base = vertex_count((VertexLattice){tree->base_level, tree->octants});
    uint32_t rows = base;
    size_t stride = ((size_t)tree->components + 7) / 8 * 8;
    for (uint32_t b = 0; b < tree->block_count; b++) rows += rows_of_block(tree, b);
    if (rows * stride * sizeof(int16_t) > VERTEX_UNPACKED_MOST) return;
    int16_t *numbers = arena_alloc(arena, sizeof *numbers, LINE_BYTES, rows * stride);
    uint32_t *first = ARENA_NEW(arena, uint32_t, tree->block_count);
    tree->unpacked_stride = (int)stride;
    int16_t *to = unpack_rows(tree, 0, tree->formats[0], base, numbers);
    uint32_t row = base;
    for (int l = 0; l < tree->level_count; l++) {
        const VertexLevel *level = &tree->levels[l];
        uint32_t end =
            l + 1 < tree->level_count ? tree->levels[l + 1].first_block : tree->block_count;
        for (uint32_t b = level->first_block; b < end; b++) {
            uint32_t count = rows_of_block(tree, b);
            uint32_t start = (uint32_t)(tree->blocks[b] >> VERTEX_BLOCK_BITS) << level->shift;
            VertexFormat format = tree->formats[tree->block_formats[b]];
            to = unpack_rows(tree, level->first_byte + start, format, count, to);
            first[b] = row;
            row += count;
        }
    }
    tree->unpacked_rows = first;
    tree->unpacked = numbers;
}

#define INTEGER_MOST 32767

Tree vertex_tree_dense(const Geodesic *geodesic, VertexLattice lattice, int components,
                       Arena *arena) {
    size_t stride = ((size_t)components + 7) / 8 * 8;
    Tree tree = {.geodesic = geodesic,
                 .basis = TREE_VERTEX,
                 .level = lattice.level,
                 .octants = lattice.octants,
                 .components = components,
                 .base_level = lattice.level,
                 .base_factor = 1,
                 .plane_level = vertex_plane_level(lattice.level),
                 .scale = ARENA_NEW(arena, float, stride),
                 .depths = ARENA_NEW(arena, uint8_t, vertex_depth_cells(lattice.octants, 0)),
                 .unpacked_stride = (int)stride};
    tree.unpacked =
        arena_alloc(arena, sizeof *tree.unpacked, LINE_BYTES, vertex_count(lattice) * stride);
    return tree;
}

void vertex_tree_fill(Tree *tree, const float *values) {
    float *scale = (float *)tree->scale;
    int16_t *to = (int16_t *)tree->unpacked;
    size_t n = (size_t)tree->components, stride = (size_t)tree->unpacked_stride;
    size_t vertices = vertex_count((VertexLattice){tree->level, tree->octants});
    for (size_t i = 0; i < vertices * n; i++)
        scale[i % n] = fmaxf(scale[i % n], fabsf(values[i]) / INTEGER_MOST);
    for (size_t k = 0; k < n; k++) scale[k] = fmaxf(scale[k], 1e-20f);
    for (size_t v = 0; v < vertices; v++)
        for (size_t k = 0; k < n; k++)
            to[v * stride + k] = (int16_t)rintf(values[v * n + k] / scale[k]);
}
