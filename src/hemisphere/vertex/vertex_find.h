/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_find.h -- vertex.h's map from directions to places and vertices. HOT.
 *
 * Threads  pure functions of constants. Fails: never.
 */
#pragma once
#include "base/mathf.h"
#include "hemisphere/vertex/vertex.h"

/* The triangle on the way down has its corner c at (x, y) in units of the finest size, and is
 * turned around (corners a and b towards -x and -y of c) when `turned` is -1, else 0. The
 * bits of 3 and 5 mark the children, 0..3, that have c in the middle of (c, a) or (a, b), and
 * of (b, c) or (a, b). */
static inline VertexPlace map_place(const Geodesic *geodesic, int plane_level, Vec3 direction)
{
    GeodesicWalk walk = geodesic_walk_start(direction);
    int          x = 0, y = 0, turned = 0;
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
static inline VertexPoint map_point(VertexLattice lattice, VertexPlace place)
{
    int   n = 1 << lattice.level;
    float x = place.x * (float)n, y = place.y * (float)n;
    int   cx = (int)x, cy = (int)y;
    cx = cx < n ? cx : n - 1;
    cy = cy < n - cx ? cy : n - 1 - cx;
    float u = x - (float)cx, v = y - (float)cy;
    int   upper = (u + v > 1) & (cx + cy + 1 < n), step = 1 - 2 * upper;
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
VertexPoint vertex_find(const Geodesic *geodesic, VertexLattice lattice, Vec3 direction);
