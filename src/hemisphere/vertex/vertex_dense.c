/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/vertex/vertex_dense.h"

#include <math.h>

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
                 .depths = ARENA_NEW(arena, uint8_t, vertex_depth_cells(lattice.octants)),
                 .stride = (int)stride};
    tree.numbers =
        arena_alloc(arena, sizeof *tree.numbers, VERTEX_LINE_BYTES, vertex_count(lattice) * stride);
    return tree;
}

void vertex_tree_fill(Tree *tree, const float *values) {
    float *scale = (float *)tree->scale;
    int16_t *to = (int16_t *)tree->numbers;
    size_t n = (size_t)tree->components, stride = (size_t)tree->stride;
    size_t vertices = vertex_count((VertexLattice){tree->level, tree->octants});
    for (size_t i = 0; i < vertices * n; i++)
        scale[i % n] = fmaxf(scale[i % n], fabsf(values[i]) / INTEGER_MOST);
    for (size_t k = 0; k < n; k++) scale[k] = fmaxf(scale[k], 1e-20f);
    for (size_t v = 0; v < vertices; v++)
        for (size_t k = 0; k < n; k++)
            to[v * stride + k] = (int16_t)rintf(values[v * n + k] / scale[k]);
}
