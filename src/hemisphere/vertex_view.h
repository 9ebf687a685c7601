/* vertex_view.h -- what tree.h's functions do on a vertex tree; called by them only. */
#pragma once
#include "hemisphere/tree_query.h"
#include "hemisphere/vertex_tree.h"

/* tree_open of a blob whose magic number is VERTEX_MAGIC, at a multiple of 8. */
bool vertex_tree_open(const void *blob, size_t size, const Geodesic *geodesic, Tree *out,
                      Error *err);

/* HOT. The interpolation between vertices of `level` (tree->level: all). */
void vertex_tree_walk(const Tree *tree, int level, Vec3 direction, TreeTaps *taps);

/* HOT. The same for a place (of octants that the tree has). */
void vertex_tree_walk_place(const Tree *tree, int level, VertexPlace place, TreeTaps *taps);

/* HOT. tree_sum. */
void vertex_tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out);

/* Bytes from a blob's start to its parts, which its counts decide. */
typedef struct VertexParts {
    size_t scale, levels, words, ranks, depths, blocks, base, rows, size;
} VertexParts;

static inline VertexParts vertex_parts(const VertexHeader *h)
{
    VertexParts p = {.scale = sizeof *h};
    VertexLattice base = {h->base_level, h->octants};
    size_t        depth_cells = (size_t)h->octants * 64;
    p.levels = p.scale + sizeof(float) * h->components;
    p.words = p.levels + sizeof(VertexLevel) * h->level_count;
    p.ranks = p.words + sizeof(uint32_t) * h->word_count;
    p.depths = p.ranks + sizeof(uint16_t) * h->word_count;
    p.blocks = (p.depths + depth_cells / 2 + 7) / 8 * 8;
    p.base = p.blocks + sizeof(uint64_t) * h->block_count;
    p.rows = p.base + sizeof(int16_t) * h->components * (size_t)vertex_count(base);
    p.size = (p.rows + h->row_bytes + VERTEX_TAIL + 7) / 8 * 8;
    return p;
}
