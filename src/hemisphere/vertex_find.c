#include "hemisphere/vertex_map.h"

VertexPlace vertex_place(const Geodesic *geodesic, int plane_level, Vec3 direction)
{
    return map_place(geodesic, plane_level, direction);
}

VertexPoint vertex_find(const Geodesic *geodesic, VertexLattice lattice, Vec3 direction)
{
    int level = vertex_plane_level(lattice.level);
    return map_point(lattice, map_place(geodesic, level, direction));
}
