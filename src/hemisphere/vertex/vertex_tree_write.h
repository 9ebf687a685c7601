/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_tree_write.h -- the integers of a vertex tree as the bytes of its blob.
 *
 * Memory   the arena's. Threads: pure functions. Fails: never.
 */
#pragma once
#include "hemisphere/vertex/vertex_tree.h"

/* A coded function: integers for every vertex of the lattice. */
typedef struct VertexCode {
    VertexLattice lattice;
    int components;
    int base_level, base_exponent;
    int exponent[GEODESIC_MAX_LEVEL]; /* of details of level base_level + l */
    float *scale;                     /* of each component */
    int16_t *integers;                /* vertices x components: base values, or details */
    bool *stored;                     /* of vertices: base vertices and those with a detail */
} VertexCode;

/* The blob; its bytes are in *size. */
const void *vertex_code_write(const VertexCode *code, Arena *arena, size_t *size);
