/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/tree_stop.h"

#include <stdlib.h>
#include <string.h>

#include "hemisphere/vertex/vertex.h"
#include "hemisphere/vertex/vertex_tree.h"

/* The base's rows are in the order of its own lattice; a coarser base has a lattice of its own,
 * of which every point is one of the finer lattice too. */
static char *coarser_rows(const char *rows, size_t row_bytes, VertexLattice from, VertexLattice to,
                          Arena *arena) {
    int n = 1 << to.level, apart = 1 << (from.level - to.level);
    size_t size = vertex_count(to) * row_bytes;
    char *out = arena_alloc(arena, 1, 64, size + VERTEX_TAIL), *at = out;
    for (int y = to.octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++, at += row_bytes)
            memcpy(at, rows + vertex_index(from, apart * x, apart * y) * row_bytes, row_bytes);
    return out;
}

/* All values at the base level stand as they are, none as details, so that those of a coarser
 * level are a base too. The map of places stays that of the whole tree. */
static void lower_base(Tree *tree, int level, Arena *arena) {
    VertexLattice from = {tree->base_level, tree->octants}, to = {level, tree->octants};
    if (tree->unpacked)
        tree->unpacked = (const int16_t *)(const void *)coarser_rows(
            (const char *)tree->unpacked, (size_t)tree->unpacked_stride * sizeof(int16_t), from, to,
            arena);
    else
        tree->details = (const uint8_t *)coarser_rows((const char *)tree->details, tree->base_bytes,
                                                      from, to, arena);
    tree->base_level = level;
    tree->level_count = 0;
}

void tree_stop(Tree *tree, int level, Arena *arena) {
    if (tree->basis == TREE_VERTEX && level < tree->base_level) lower_base(tree, level, arena);
    tree->level = level;
}
