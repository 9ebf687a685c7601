/* SPDX-License-Identifier: Apache-2.0 */
/* normal_map.h -- shading normals that textures bend, in the tangent frame of the vertices.
 *
 * Frame    world; unit vectors.  Threads  pure functions.  Fails  never.
 */
#pragma once
#include "light/triangle_point.h"

/* The vertices' tangent, made perpendicular to ns, and bitangent; false: none. */
bool point_tangent(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                   Vec3 *along, Vec3 *across);

/* ns as the slot's texture bends it, times `scale` along the surface; ns without a texture. */
Vec3 mapped_normal(const Scene *scene, const TextureSlot *slot, float scale, uint32_t triangle,
                   const TrianglePoint *point);

/* The clear coat's own normal, on ns's side. */
Vec3 coat_normal(const Scene *scene, const Material *material, uint32_t triangle,
                 const TrianglePoint *point);
