/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/tree_expand.h"

#include <string.h>

#include "hemisphere/tree/haar.h"
#include "hemisphere/tree/tree_query.h"
#include "hemisphere/tree/vertex.h"
#include "hemisphere/tree/vertex_open.h"

static float integer_at(const char *from, bool is_byte, size_t index) {
    return is_byte ? ((const int8_t *)(const void *)from)[index]
                   : ((const int16_t *)(const void *)from)[index];
}

static void place_row(const Tree *tree, uint32_t row, int level, float *to) {
    size_t components = (size_t)tree->components;
    const float *scale = tree->scales ? tree->scales + level * tree->components : NULL;
    if (tree->format == TREE_ROWS_FLOAT) {
        memcpy(to, (const float *)tree->rows + row * components, components * sizeof(float));
    } else {
        const char *from = (const char *)tree->rows + tree_row_offset(tree, row);
        for (size_t c = 0; c < components; c++)
            to[c] = scale[c] * integer_at(from, row >= tree->byte_row, c);
    }
}

/* Details to their places in haar.h's layout. ids: of each node's triangle on its level. */
static void place_rows(const Tree *tree, float *leaves, uint32_t *ids) {
    uint32_t level_end = (uint32_t)tree->octants, next = level_end, row = 0;
    int level = 0;
    for (uint32_t i = 0; i < tree->node_count; i++) {
        if (i < (uint32_t)tree->octants) ids[i] = i;
        if (i == level_end) {
            level_end = next;
            level++;
        }
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t child = 4 * ids[i] + k;
            if (tree->nodes[i].children >> k & 1) ids[next++] = child;
            if (k == 0 || !(tree->nodes[i].rows >> (k - 1) & 1)) continue;
            size_t place = (size_t)child << 2 * (tree->level - level - 1);
            place_row(tree, row++, level, leaves + place * (size_t)tree->components);
        }
    }
}

void tree_expand(const Tree *tree, float *leaves, Arena scratch) {
    HaarShape shape = {tree->level, tree->octants, tree->components,
                       tree->has_area_weights ? HAAR_AREA : HAAR_EQUAL};
    size_t components = (size_t)tree->components;
    if (tree->basis == TREE_VERTEX) {
        for (uint32_t i = 0; i < haar_leaf_count(&shape); i++)
            tree_interpolate(tree, geodesic_center(tree->level, i), leaves + i * components);
        return;
    }
    memset(leaves, 0, haar_leaf_count(&shape) * components * sizeof(float));
    for (size_t q = 0; q < (size_t)tree->octants; q++)
        memcpy(leaves + (q << 2 * tree->level) * components, tree->means + q * components,
               components * sizeof(float));
    place_rows(tree, leaves, ARENA_NEW(&scratch, uint32_t, tree->node_count));
    haar_inverse(&shape, leaves, scratch);
}

uint32_t tree_point_count(const Tree *tree) {
    if (tree->basis == TREE_VERTEX)
        return vertex_count((VertexLattice){tree->level, tree->octants});
    return (uint32_t)tree->octants << 2 * tree->level;
}

void tree_expand_points(const Tree *tree, int level, float *out) {
    if (tree->basis == TREE_VERTEX) {
        vertex_tree_expand_level(tree, level, out);
        return;
    }
    uint32_t count = (uint32_t)tree->octants << 2 * level;
    for (uint32_t i = 0; i < count; i++)
        tree_interpolate(tree, geodesic_center(level, i), out + i * (size_t)tree->components);
}
