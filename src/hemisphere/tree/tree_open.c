/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/tree_open.h"

#include <math.h>

#include "hemisphere/tree.h"
#include "hemisphere/tree/vertex_open.h"
#include "hemisphere/tree/vertex_tree.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "blobs are little-endian in place");
_Static_assert(sizeof(TreeHeader) == 56 && sizeof(TreeNode) == 8, "the blob's layout");

size_t tree_size(const void *blob) {
    uint32_t magic = *(const uint32_t *)blob;
    if (magic == VERTEX_MAGIC) return ((const VertexHeader *)blob)->size;
    return ((const TreeHeader *)blob)->size;
}

static bool refuse(Error *err, const char *what, double found, double wanted) {
    return error_set(err, ERROR_INPUT, "tree: %s is %.9g, required: %.9g", what, found, wanted);
}

static bool check_header(const TreeHeader *h, size_t size, Error *err) {
    if (h->magic != TREE_MAGIC) return refuse(err, "magic number", h->magic, TREE_MAGIC);
    if (h->version != TREE_VERSION) return refuse(err, "version", h->version, TREE_VERSION);
    if (h->size > size)
        return error_set(err, ERROR_INPUT, "tree: %zu bytes are there, required: %llu", size,
                         (unsigned long long)h->size);
    if (h->level > GEODESIC_MAX_LEVEL) return refuse(err, "level", h->level, GEODESIC_MAX_LEVEL);
    if (h->octants != 2 && h->octants != 4) return refuse(err, "octant count", h->octants, 4);
    if (h->weights > 1) return refuse(err, "weight kind", h->weights, 1);
    if (h->rows > TREE_ROWS_INT16) return refuse(err, "row format", h->rows, TREE_ROWS_INT16);
    if (h->components < 1 || h->components > TREE_MAX_COMPONENTS)
        return refuse(err, "component count", h->components, TREE_MAX_COMPONENTS);
    if (h->byte_level != 0 && (h->byte_level >= h->level || h->rows == TREE_ROWS_FLOAT))
        return refuse(err, "level of 8-bit rows", h->byte_level, 0);
    return true;
}

/* The header's offsets are a function of its counts; anything else is no tree of ours. Counts
 * are limited by the leaves, so that no sum of sizes can overflow. */
static bool check_offsets(const TreeHeader *h, Error *err) {
    uint64_t leaves = (uint64_t)h->octants << 2 * h->level;
    if (h->node_count < h->octants || h->node_count > 2 * leaves)
        return refuse(err, "node count", h->node_count, h->octants);
    if (h->row_count >= leaves) return refuse(err, "row count", h->row_count, (double)leaves);
    uint64_t row = 4 * (uint64_t)h->components;
    uint64_t scales = sizeof(TreeHeader) + h->octants * row;
    uint64_t scale_bytes = h->rows == TREE_ROWS_FLOAT ? 0 : h->level * row;
    uint64_t nodes = (scales + scale_bytes + 7) / 8 * 8;
    uint64_t rows = nodes + sizeof(TreeNode) * (uint64_t)h->node_count;
    if (h->means_offset != sizeof(TreeHeader))
        return refuse(err, "offset of the means", h->means_offset, sizeof(TreeHeader));
    if (h->scales_offset != scales)
        return refuse(err, "offset of the scales", h->scales_offset, (double)scales);
    if (h->nodes_offset != nodes)
        return refuse(err, "offset of the nodes", h->nodes_offset, (double)nodes);
    if (h->rows_offset != rows || rows > h->size)
        return refuse(err, "offset of the rows", (double)h->rows_offset, (double)rows);
    return true;
}

/* The nodes determine how many rows have 8 bits, and so how long the rows are. */
static bool check_size(const TreeHeader *h, const Tree *tree, Error *err) {
    uint64_t bytes = 4ull * h->components * h->row_count;
    if (tree->format == TREE_ROWS_INT16) bytes = tree_row_offset(tree, h->row_count);
    uint64_t size = (h->rows_offset + bytes + 7) / 8 * 8;
    if (h->size != size) return refuse(err, "size", (double)h->size, (double)size);
    return true;
}

/* Nodes stand level by level, children and rows in order: each index must continue the last.
 * Finds the first row of byte_level. */
static bool check_nodes(Tree *tree, uint32_t byte_level, Error *err) {
    uint32_t next_node = (uint32_t)tree->octants, next_row = 0, level_end = next_node;
    int level = 0;
    for (uint32_t i = 0; i < tree->node_count; i++) {
        TreeNode node = tree->nodes[i];
        if (i == level_end) {
            level_end = next_node;
            level++;
            if (level == (int)byte_level) tree->byte_row = next_row;
        }
        if (node.children >> 4 != next_node || node.rows >> 3 != next_row)
            return error_set(err, ERROR_INPUT,
                             "tree: node %u points to node %u and row %u, "
                             "required: %u and %u",
                             i, node.children >> 4, node.rows >> 3, next_node, next_row);
        next_node += (uint32_t)__builtin_popcount(node.children & 15);
        next_row += (uint32_t)__builtin_popcount(node.rows & 7);
        if (next_node > tree->node_count || next_row > tree->row_count)
            return error_set(err, ERROR_INPUT,
                             "tree: node %u leads to node %u of %u and row %u "
                             "of %u",
                             i, next_node, tree->node_count, next_row, tree->row_count);
        if (level >= tree->level && (node.children & 15 || node.rows & 7))
            return error_set(err, ERROR_INPUT,
                             "tree: node %u has children below the leaves' "
                             "level %d",
                             i, tree->level);
    }
    if (next_node != tree->node_count)
        return refuse(err, "node count", tree->node_count, next_node);
    if (next_row != tree->row_count) return refuse(err, "row count", tree->row_count, next_row);
    return true;
}

static bool check_finite(const float *values, size_t count, const char *what, Error *err) {
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return error_set(err, ERROR_INPUT, "tree: %s %zu is %g, required: a finite number",
                             what, i, (double)values[i]);
    return true;
}

static bool check_values(const Tree *tree, Error *err) {
    size_t row = (size_t)tree->components;
    if (!check_finite(tree->means, row * (size_t)tree->octants, "mean", err)) return false;
    if (tree->format != TREE_ROWS_FLOAT)
        return check_finite(tree->scales, row * (size_t)tree->level, "scale", err);
    return check_finite(tree->rows, row * tree->row_count, "detail", err);
}

static Tree view(const char *blob, const Geodesic *geodesic) {
    const TreeHeader *h = (const TreeHeader *)(const void *)blob;
    const char *rows = blob + h->rows_offset;
    const char *scales = h->rows == TREE_ROWS_FLOAT ? NULL : blob + h->scales_offset;
    return (Tree){.geodesic = geodesic,
                  .nodes = (const TreeNode *)(const void *)(blob + h->nodes_offset),
                  .means = (const float *)(const void *)(blob + h->means_offset),
                  .scales = (const float *)(const void *)scales,
                  .rows = rows,
                  .level = h->level,
                  .octants = h->octants,
                  .components = (int)h->components,
                  .has_area_weights = h->weights == 1,
                  .format = (TreeRowFormat)h->rows,
                  .row_count = h->row_count,
                  .node_count = h->node_count,
                  .byte_row = h->row_count};
}

bool tree_open(const void *blob, size_t size, const Geodesic *geodesic, Arena *arena, Tree *out,
               Error *err) {
    if ((uintptr_t)blob % 8 != 0)
        return error_set(err, ERROR_INPUT, "tree: stands at an address that is no multiple of 8");
    if (size >= sizeof(uint32_t) && *(const uint32_t *)blob == VERTEX_MAGIC)
        return vertex_tree_open(blob, size, geodesic, arena, out, err);
    if (size < sizeof(TreeHeader))
        return refuse(err, "number of bytes", (double)size, sizeof(TreeHeader));
    const TreeHeader *header = blob;
    if (!check_header(header, size, err) || !check_offsets(header, err)) return false;
    if (geodesic->level < header->level)
        return refuse(err, "level of the geodesic", geodesic->level, header->level);
    Tree tree = view(blob, geodesic);
    if (!check_nodes(&tree, header->byte_level, err) || !check_size(header, &tree, err) ||
        !check_values(&tree, err))
        return false;
    *out = tree;
    return true;
}
