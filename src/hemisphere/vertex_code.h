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

/* Asks the caller's question and remembers: what lies well within a distance from the value that
 * was accepted once is taken as accepted, whatever its direction. The finished tree is checked
 * without that. */
typedef struct VertexJudge {
    const VertexTreeOptions *options;
    const float             *values; /* vertices x components */
    const float             *unit;   /* what an error of each component counts in, > 0 */
    float                   *safe;   /* of vertices: the largest accepted distance, in units; < 0:
                                never taken as accepted */
    bool                     is_exact; /* does not use what it remembers */
} VertexJudge;

bool vertex_accepts(VertexJudge *judge, uint32_t vertex, const float *row);

/* The same for value + factor * (row - value). */
bool vertex_accepts_beyond(VertexJudge *judge, uint32_t vertex, const float *row, float factor);

/* Vertices to store (the base's included) and the values that the tree should have. */
typedef struct VertexChoice {
    bool  *chosen; /* of vertices */
    float *target; /* vertices x components, of all vertices */
} VertexChoice;

/* Chooses few vertices, with values that are accepted everywhere with room for rounding. */
void vertex_choose(VertexJudge *judge, int base_level, Arena scratch, VertexChoice *out);

/* The blob; its bytes are in *size. */
const void *vertex_code_write(const VertexCode *code, Arena *arena, size_t *size);
