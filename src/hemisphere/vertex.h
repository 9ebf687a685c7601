/* vertex.h -- the vertices of the geodesic triangles as an integer lattice, and functions that
 * are linear between them.
 *
 * Halving the edges of the octahedron's upper half puts the vertices of level i one to one on
 * the lattice points (x, y) with |x| + |y| <= 2^i: the pole is (0, 0), the axes +x and +y are
 * (2^i, 0) and (0, 2^i), and a new vertex lies midway between the two ends of its edge. A vertex
 * of level i is the vertex (2x, 2y) of level i + 1. Triangles that share an edge name its
 * midpoint by the same point, also across octants. Functions that are symmetric in y need the
 * points with y >= 0 only (octants = 2).
 *
 * Frame     as geodesic.h. Threads: pure functions of constants.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/geodesic.h"

typedef struct VertexLattice {
    int level;   /* 0..GEODESIC_MAX_LEVEL - 1 */
    int octants; /* 4, or 2: mirror-symmetric in y */
} VertexLattice;

/* Vertices of the lattice: 2n(n+1)+1 or (n+1)^2 with n = 2^level. */
uint32_t vertex_count(VertexLattice lattice);

/* Index of a lattice point (row by row in y, then x), 0 .. vertex_count - 1. */
uint32_t vertex_index(VertexLattice lattice, int x, int y);

/* Unit vectors of all vertices, in order of index. */
void vertex_directions(VertexLattice lattice, Vec3 *direction);

/* HOT. The three vertices around a direction and its barycentric weights in the plane of the
 * triangle's corners (they sum to 1). With octants = 2, y counts as |y|. */
typedef struct VertexPoint {
    uint32_t vertex[3];
    float    weight[3];
} VertexPoint;
VertexPoint vertex_find(const Geodesic *geodesic, VertexLattice lattice, Vec3 direction);

/* ---- from samples to vertices ----------------------------------------------------------- */

typedef struct VertexSamples {
    int          count, components;
    const Vec3  *direction;
    const float *value;  /* count x components */
    const float *weight; /* count, >= 0; NULL: all 1 */
} VertexSamples;

/* Vertex values (vertex_count x components) whose linear interpolation fits the samples best:
 * least squares with the penalty ridge * 16^i * detail^2 on the details of level i (the value of
 * a new vertex less the mean of its edge's ends), relative to the samples' total weight. What no
 * sample reaches stays smooth. Solved by conjugate gradients over the hierarchical details. */
bool vertex_fit(const Geodesic *geodesic, VertexLattice lattice, const VertexSamples *samples,
                double ridge, Arena *scratch, float *values, Error *err);
