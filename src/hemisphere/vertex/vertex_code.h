/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_code.h -- a vertex tree between its coder and its blob; private to those. */
#pragma once
#include "hemisphere/vertex/vertex_tree.h"

/* A coded function: integers for every vertex of the lattice. */
typedef struct VertexCode {
    VertexLattice lattice;
    int           components;
    int           base_level, base_exponent;
    int           exponent[GEODESIC_MAX_LEVEL]; /* of details of level base_level + l */
    float        *scale;    /* of each component */
    int16_t      *integers; /* vertices x components: base values, or details */
    bool         *stored;   /* of vertices: base vertices and those with a detail */
} VertexCode;
