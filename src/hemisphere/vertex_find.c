#include "base/mathf.h"
#include "hemisphere/vertex.h"

/* The triangle on the way down: its corner c at (x, y) in units of the finest size, and whether
 * it is turned around (its corners a, b then lie towards -x, -y of c). */
VertexPlace vertex_place(const Geodesic *geodesic, int plane_level, Vec3 direction)
{
    GeodesicWalk walk = geodesic_walk_start(direction);
    int          x = 0, y = 0, sign = 1;
    for (int i = 0; i < plane_level; i++) {
        uint32_t child = geodesic_walk_down(geodesic, i, &walk);
        int      step = sign << (plane_level - 1 - i);
        x += child < 2 ? step : 0;          /* 0: middle of (a, b); 1: middle of (c, a) */
        y += child == 0 || child == 2 ? step : 0;
        sign = child == 0 ? -sign : sign;
    }
    float u = walk.weight[0], v = walk.weight[1], w = walk.weight[2];
    float sum = u + v + w, scale = sum > 0 ? (float)sign / sum : 0.0f;
    float size = 1.0f / (float)(1 << plane_level);
    float px = ((float)x + u * scale) * size, py = ((float)y + v * scale) * size;
    return (VertexPlace){clampf(px, 0, 1), clampf(py, 0, 1), walk.octant};
}

VertexPoint vertex_point(VertexLattice lattice, VertexPlace place)
{
    int   n = 1 << lattice.level;
    float x = place.x * (float)n, y = place.y * (float)n;
    int   cx = (int)x, cy = (int)y;
    cx = cx < n ? cx : n - 1;
    cy = cy < n - cx ? cy : n - 1 - cx;
    float u = x - (float)cx, v = y - (float)cy;
    bool  turned = u + v > 1 && cx + cy + 1 < n;
    u = turned ? 1 - u : u;
    v = turned ? 1 - v : v;
    v = v < 1 - u ? v : 1 - u; /* rounding at the horizon */
    v = v > 0 ? v : 0.0f;
    int step = turned ? -1 : 1;
    cx += turned;
    cy += turned;
    int sx = place.octant & 1 ? -1 : 1, sy = place.octant & 2 ? -1 : 1;
    return (VertexPoint){{vertex_index(lattice, sx * (cx + step), sy * cy),
                          vertex_index(lattice, sx * cx, sy * (cy + step)),
                          vertex_index(lattice, sx * cx, sy * cy)},
                         {u, v, 1 - u - v}};
}

VertexPoint vertex_find(const Geodesic *geodesic, VertexLattice lattice, Vec3 direction)
{
    int level = vertex_plane_level(lattice.level);
    return vertex_point(lattice, vertex_place(geodesic, level, direction));
}
