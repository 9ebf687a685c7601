/* SPDX-License-Identifier: Apache-2.0 */
/* texture_slot.h -- a material's textures on a triangle: their coordinates, and the shading
 * normals that they bend, in the tangent frame of the vertices.
 *
 * Frame    world; unit vectors.  Threads  pure functions.  Fails  never.
 */
#pragma once
#include "scene/point/ray_ends.h"

/* At a point and at a corner. */
Vec2 slot_uv(const TextureSlot *slot, const TrianglePoint *point);
Vec2 slot_corner_uv(const Scene *scene, const TextureSlot *slot, uint32_t triangle, int corner);

/* The vertices' tangent, made perpendicular to ns, and bitangent; false: none. */
bool point_tangent(const Scene *scene, uint32_t triangle, const TrianglePoint *point, Vec3 *along,
                   Vec3 *across);

/* ns as the slot's texture bends it, times `scale` along the surface; ns without a texture. */
Vec3 mapped_normal(const Scene *scene, const TextureSlot *slot, Vec2 scale, uint32_t triangle,
                   const TrianglePoint *point);

/* The clear coat's own normal, on ns's side. */
Vec3 coat_normal(const Scene *scene, const Material *material, uint32_t triangle,
                 const TrianglePoint *point);
