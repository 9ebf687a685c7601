/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/vertex.h"

#include <stdlib.h>

/* ---- directions -------------------------------------------------------------------------- */

/* A point of the lattice's plane on its way down octant 0: (x, y) relative to the corner c of
 * its triangle, in the triangle's own directions, where the triangle has `size`. */
typedef struct Descent {
    int x, y, size;
    uint32_t id;
} Descent;

/* The children of x, y >= 0, x + y <= size: geodesic.h's numbering. */
static void step_down(Descent *d) {
    int half = d->size / 2, child = 0;
    if (d->x >= half) child = 1;
    else if (d->y >= half) child = 2;
    else if (d->x + d->y <= half) child = 3;
    if (child == 0) { /* turned around: its corner c is the midpoint of (a, b) */
        d->x = half - d->x;
        d->y = half - d->y;
    }
    if (child == 1) d->x -= half;
    if (child == 2) d->y -= half;
    d->id = 4 * d->id + (uint32_t)child;
    d->size = half;
}

/* The direction of the point (x, y) of octant 0, x + y <= 2^level. */
static Vec3 direction_in_octant(int level, int x, int y) {
    int plane = vertex_plane_level(level);
    Descent d = {x, y, 1 << level, 0};
    for (int i = 0; i < plane; i++) step_down(&d);
    GeodesicTriangle t = geodesic_triangle(plane, d.id);
    double weight[3] = {d.x, d.y, d.size - d.x - d.y}, sum[3] = {0, 0, 0}, square = 0;
    for (int i = 0; i < 3; i++) {
        sum[0] += weight[i] * (double)t.corner[i].x;
        sum[1] += weight[i] * (double)t.corner[i].y;
        sum[2] += weight[i] * (double)t.corner[i].z;
    }
    for (int i = 0; i < 3; i++) square += sum[i] * sum[i];
    double scale = 1 / sqrt(square);
    return vec3((float)(sum[0] * scale), (float)(sum[1] * scale), (float)(sum[2] * scale));
}

Vec3 vertex_direction(VertexLattice lattice, int x, int y) {
    Vec3 d = direction_in_octant(lattice.level, abs(x), abs(y));
    return vec3(x < 0 ? -d.x : d.x, y < 0 ? -d.y : d.y, d.z);
}

void vertex_directions(VertexLattice lattice, Vec3 *direction) {
    int n = 1 << lattice.level;
    for (int y = 0; y <= n; y++)
        for (int x = 0; x <= n - y; x++) {
            Vec3 d = direction_in_octant(lattice.level, x, y);
            direction[vertex_index(lattice, x, y)] = d;
            direction[vertex_index(lattice, -x, y)] = vec3(-d.x, d.y, d.z);
            if (lattice.octants == 2) continue;
            direction[vertex_index(lattice, x, -y)] = vec3(d.x, -d.y, d.z);
            direction[vertex_index(lattice, -x, -y)] = vec3(-d.x, -d.y, d.z);
        }
}

/* ---- edges ------------------------------------------------------------------------------- */

uint32_t vertex_edges(VertexLattice lattice, int level, VertexEdge *edges) {
    int n = 1 << lattice.level, half = n >> (level + 1);
    uint32_t count = 0;
    for (int y = lattice.octants == 2 ? 0 : -n; y <= n; y += half)
        for (int x = abs(y) - n; x <= n - abs(y); x += half) {
            int dx = x & half ? half : 0, dy = y & half ? half : 0;
            if (!dx && !dy) continue;
            uint32_t cell_edge = dx && dy ? 2u : dx ? 0u : 1u;
            if (cell_edge == 2 && (x < 0) == (y < 0)) dy = -dy;
            if (edges)
                edges[count] = (VertexEdge){
                    x,
                    y,
                    vertex_index(lattice, x, y),
                    {vertex_index(lattice, x - dx, y - dy), vertex_index(lattice, x + dx, y + dy)},
                    cell_edge};
            count++;
        }
    return count;
}
