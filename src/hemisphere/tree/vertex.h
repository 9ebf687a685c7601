/* SPDX-License-Identifier: Apache-2.0 */
/* vertex.h -- the vertices of the geodesic triangles as an integer lattice, and functions that
 * are linear between them.
 *
 * Halving the edges of the octahedron's upper half puts the vertices of level i one to one on
 * the lattice points (x, y) with |x| + |y| <= 2^i: the pole is (0, 0), the axes +x and +y are
 * (2^i, 0) and (0, 2^i), and a new vertex lies midway between the two ends of its edge. A
 * vertex of level i is the vertex (2x, 2y) of level i + 1. Triangles that share an edge name
 * its midpoint by the same point, also across octants. Functions that are symmetric in y need
 * the points with y >= 0 only (octants = 2).
 *
 * Map       A direction has a place on the lattice's plane: inside a triangle of level
 *           VERTEX_PLANE_LEVEL (of the lattice's level, when that is less) its barycentric
 *           coordinates in the plane of the triangle's corners. Finer triangles halve these in
 *           that plane: their vertices lie within 0.003 degrees of geodesic.h's, and a query
 *           needs 4 steps down with tables of 1 KB instead of up to 9 with 1 MB. The map is
 *           continuous and one to one, and what is linear between the lattice's vertices is
 *           linear in the place.
 * Frame     as geodesic.h. Threads: pure functions of constants.
 */
#pragma once
#include "base/mathf.h"
#include "hemisphere/geodesic.h"

#define VERTEX_PLANE_LEVEL 4

typedef struct VertexLattice {
    int level;   /* 0..GEODESIC_MAX_LEVEL - 1 */
    int octants; /* 4, or 2: mirror-symmetric in y */
} VertexLattice;

/* Vertices of the lattice: 2n(n+1)+1 or (n+1)^2 with n = 2^level. */
static inline uint32_t vertex_count(VertexLattice lattice) {
    uint32_t n = 1u << lattice.level;
    return lattice.octants == 2 ? (n + 1) * (n + 1) : 2 * n * (n + 1) + 1;
}

/* Index of a lattice point (row by row in y, then x), 0 .. vertex_count - 1. Below the x axis
 * t^2 points stand before the row that is t rows from the lattice's end, and t before its
 * middle; above the axis it is the same from the other end. */
static inline uint32_t vertex_index(VertexLattice lattice, int x, int y) {
    int n = 1 << lattice.level, half = lattice.octants == 2, below = y >> 31;
    int t = n - ((y ^ below) - below), before = t * t + t;
    int last = 2 * n * (n + 1) - half * n * n;
    below &= half - 1; /* a mask: the sign of y is as good as random in queries */
    return (uint32_t)(x + ((before & below) | ((last - before) & ~below)));
}

/* Unit vector of a lattice point; of all vertices, in order of index. */
Vec3 vertex_direction(VertexLattice lattice, int x, int y);
void vertex_directions(VertexLattice lattice, Vec3 *direction);

/* HOT. A direction's place in its octant: the x axis is at (1, 0), the y axis at (0, 1), the
 * pole at (0, 0). x, y >= 0; x + y <= 1 but for rounding. z < 0 counts as 0. */
typedef struct VertexPlace {
    float x, y;
    uint32_t octant; /* as geodesic.h's */
} VertexPlace;

static inline int vertex_plane_level(int level) {
    return level < VERTEX_PLANE_LEVEL ? level : VERTEX_PLANE_LEVEL;
}

/* HOT. The three vertices around a direction and its barycentric weights (>= 0, they sum to
 * 1). With octants = 2, y counts as |y|. */
typedef struct VertexPoint {
    uint32_t vertex[3];
    float weight[3];
} VertexPoint;

/* ---- edges ------------------------------------------------------------------------------ */

/* The new vertices of a level, as edges of the next coarser one. */
typedef struct VertexEdge {
    int x, y;        /* of the lattice's finest level */
    uint32_t vertex; /* index in it */
    uint32_t end[2];
    uint32_t cell_edge; /* 0 along x, 1 along y, 2 diagonal */
} VertexEdge;

/* Edges of level i of a lattice; `edges` NULL: only their number. */
uint32_t vertex_edges(VertexLattice lattice, int level, VertexEdge *edges);

/* ---- the map; HOT ------------------------------------------------------------------------ */

/* The triangle on the way down has its corner c at (x, y) in units of the finest size, and is
 * turned around (corners a and b towards -x and -y of c) when `turned` is -1, else 0. The
 * bits of 3 and 5 mark the children, 0..3, that have c in the middle of (c, a) or (a, b), and
 * of (b, c) or (a, b). */
static inline VertexPlace map_place(const Geodesic *geodesic, int plane_level, Vec3 direction) {
    GeodesicWalk walk = geodesic_walk_start(direction);
    int x = 0, y = 0, turned = 0;
    for (int i = 0; i < plane_level; i++) {
        uint32_t child = geodesic_walk_down(geodesic, i, &walk);
        x = 2 * x + ((int)(3u >> child & 1) ^ turned) - turned;
        y = 2 * y + ((int)(5u >> child & 1) ^ turned) - turned;
        turned ^= -(int)(child == 0);
    }
    float u = walk.weight[0], v = walk.weight[1], w = walk.weight[2];
    float sum = u + v + w, scale = sum > 0 ? (float)(1 + 2 * turned) / sum : 0.0f;
    float size = 1.0f / (float)(1 << plane_level);
    float px = ((float)x + u * scale) * size, py = ((float)y + v * scale) * size;
    return (VertexPlace){clampf(px, 0, 1), clampf(py, 0, 1), walk.octant};
}

/* The half of a cell that holds the place: 0 towards the pole, 1 the other one, which cells on
 * the horizon do not have. Either is as likely, so there are no branches. */
static inline VertexPoint map_point(VertexLattice lattice, VertexPlace place) {
    int n = 1 << lattice.level;
    float x = place.x * (float)n, y = place.y * (float)n;
    int cx = (int)x, cy = (int)y;
    cx = cx < n ? cx : n - 1;
    cy = cy < n - cx ? cy : n - 1 - cx;
    float u = x - (float)cx, v = y - (float)cy;
    int upper = (u + v > 1) & (cx + cy + 1 < n), step = 1 - 2 * upper;
    u = fabsf((float)upper - u);
    v = fabsf((float)upper - v);
    float most = 1 - u; /* less than v by rounding at the horizon only */
    v = v < most ? v : most;
    v = v > 0 ? v : 0.0f;
    cx += upper;
    cy += upper;
    int mx = -(int)(place.octant & 1), my = -(int)(place.octant >> 1);
    int x0 = (cx ^ mx) - mx, y0 = (cy ^ my) - my;
    int x1 = ((cx + step) ^ mx) - mx, y1 = ((cy + step) ^ my) - my;
    return (VertexPoint){{vertex_index(lattice, x1, y0), vertex_index(lattice, x0, y1),
                          vertex_index(lattice, x0, y0)},
                         {u, v, 1 - u - v}};
}

/* Both together. */
static inline VertexPoint vertex_find(const Geodesic *geodesic, VertexLattice lattice,
                                      Vec3 direction) {
    int level = vertex_plane_level(lattice.level);
    return map_point(lattice, map_place(geodesic, level, direction));
}
