/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_open.h -- checks the blob of a vertex tree and makes its view; what tree_open calls.
 *
 * Memory   views into the blob. Threads: pure functions. Fails: naming what is wrong.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/vertex/vertex_tree.h"

/* tree_open of a blob whose magic number is VERTEX_MAGIC, at a multiple of 8. */
bool vertex_tree_open(const void *blob, size_t size, const Geodesic *geodesic, Tree *out,
                      Error *err);

/* Bytes from a blob's start to its parts, which its counts decide. */
typedef struct VertexParts {
    size_t scale, levels, words, formats, ranks, depths, block_formats, blocks, rows, size;
} VertexParts;

/* Cells of a depth level: of the square around the lattice's plane, or of its half. */
static inline size_t vertex_depth_cells(int octants, int depth_level) {
    return (size_t)octants << 2 * depth_level;
}

static inline VertexParts vertex_parts(const VertexHeader *h) {
    VertexParts p = {.scale = sizeof *h};
    p.levels = p.scale + sizeof(float) * h->components;
    p.words = p.levels + sizeof(VertexLevel) * h->level_count;
    p.formats = p.words + sizeof(uint32_t) * h->word_count;
    p.ranks = p.formats + sizeof(VertexFormat) * h->format_count;
    p.depths = p.ranks + sizeof(uint16_t) * h->word_count;
    p.block_formats = p.depths + vertex_depth_cells(h->octants, h->depth_level) / 2;
    p.blocks = (p.block_formats + h->block_count + 7) / 8 * 8;
    p.rows = p.blocks + sizeof(uint64_t) * h->block_count;
    p.size = (p.rows + h->row_bytes + VERTEX_TAIL + 7) / 8 * 8;
    return p;
}

/* The tree's function at the vertices of its lattice: vertex_count x components floats. */
void vertex_tree_expand(const Tree *tree, float *values);

/* The same at the vertices of `level`, the tree's own or a finer one. */
void vertex_tree_expand_level(const Tree *tree, int level, float *values);
