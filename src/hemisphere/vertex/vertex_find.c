/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/vertex/vertex_find.h"

VertexPoint vertex_find(const Geodesic *geodesic, VertexLattice lattice, Vec3 direction)
{
    int level = vertex_plane_level(lattice.level);
    return map_point(lattice, map_place(geodesic, level, direction));
}
