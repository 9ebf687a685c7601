/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_code.h -- the integers of a vertex tree as the bytes of its blob (vertex_tree.h), and
 * back.
 *
 * Memory   the arena's. Threads: pure functions. The same bytes on every machine.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree/vertex_tree.h"

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

/* The blob; its bytes are in *size. Fails: never. */
const void *vertex_encode(const VertexCode *code, Arena *arena, size_t *size);

/* What a blob's bits say. */
typedef struct VertexRows {
    int16_t *numbers; /* the base's rows, then the details', in the order of the bits */
    int stride;       /* numbers from row to row, a multiple of 8; behind the components 0 */
    bool *stored;     /* as VertexCode's */
} VertexRows;

/* h: a header that was checked, and the blob behind it. Damaged bits make other integers,
 * within VERTEX_LEAST and VERTEX_MOST, or false: not as many rows as the header says. */
bool vertex_decode(const VertexHeader *h, Arena *arena, VertexRows *out);
