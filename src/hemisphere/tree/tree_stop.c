/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/tree_stop.h"

#include <stdlib.h>
#include <string.h>

#include "hemisphere/tree/vertex.h"
#include "hemisphere/tree/vertex_tree.h"

/* All values at the base level stand as they are, none as details, so that those of a coarser
 * level are a base too. The base's rows are in the order of its own lattice; a coarser base has
 * a lattice of its own, of which every point is one of the finer lattice too. The map of places
 * stays that of the whole tree. */
static void lower_base(Tree *tree, int level, Arena *arena) {
    VertexLattice from = {tree->base_level, tree->octants}, to = {level, tree->octants};
    int n = 1 << level, apart = 1 << (from.level - level);
    size_t stride = (size_t)tree->stride, size = vertex_count(to) * stride;
    int16_t *out = arena_alloc(arena, sizeof *out, VERTEX_LINE_BYTES, size), *at = out;
    for (int y = to.octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++, at += stride)
            memcpy(at, tree->numbers + vertex_index(from, apart * x, apart * y) * stride,
                   sizeof *out * stride);
    tree->numbers = out;
    tree->base_level = level;
    tree->level_count = 0;
}

void tree_stop(Tree *tree, int level, Arena *arena) {
    if (tree->basis == TREE_VERTEX && level < tree->base_level) lower_base(tree, level, arena);
    tree->level = level;
}
