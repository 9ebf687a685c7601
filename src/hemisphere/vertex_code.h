/* vertex_code.h -- a vertex tree between its coder and its blob; private to those. */
#pragma once
#include "hemisphere/vertex_tree.h"

/* What is stored of a function: integers for every vertex of the lattice. */
typedef struct VertexCode {
    VertexLattice lattice;
    int           components;
    int           base_level, base_exponent;
    int           exponent[GEODESIC_MAX_LEVEL]; /* of details of level base_level + l */
    float        *scale;    /* of each component */
    int16_t      *integers; /* vertices x components: base values, or details */
    bool         *stored;   /* of vertices: base vertices and those with a detail */
} VertexCode;

/* The new vertices of a level, as edges of the next coarser one. */
typedef struct VertexEdge {
    int      x, y;     /* of the lattice's finest level */
    uint32_t vertex;   /* index in it */
    uint32_t end[2];
    uint32_t cell_edge; /* 0 along x, 1 along y, 2 diagonal */
} VertexEdge;

/* Edges of level i of a lattice; `edges` NULL: only their number. */
uint32_t vertex_edges(VertexLattice lattice, int level, VertexEdge *edges);

/* The blob; its bytes are in *size. */
const void *vertex_code_write(const VertexCode *code, Arena *arena, size_t *size);
