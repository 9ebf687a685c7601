/* SPDX-License-Identifier: Apache-2.0 */
/* triangle_point.h -- a point of a triangle: its place, its normals, its texture coordinates.
 *
 * Units    m, world.  Threads  pure functions.  Fails  never.
 */
#pragma once
#include "scene/scene.h"

/* A point of a triangle, interpolated. */
typedef struct TrianglePoint {
    Vec3  position;
    Vec3  ng;    /* unit, the front's side (counter-clockwise vertices) */
    Vec3  ns;    /* unit, interpolated vertex normal; ng where that vanishes */
    Vec2  uv[SCENE_UV_SETS];
    float u, v;  /* barycentric weights of vertices 1 and 2 */
} TrianglePoint;

TrianglePoint triangle_point(const Scene *scene, uint32_t triangle, float u, float v);

/* Its position alone. */
Vec3 triangle_position(const Scene *scene, uint32_t triangle, float u, float v);

/* Texture coordinates of a slot, at a point and at a corner. */
Vec2 slot_uv(const TextureSlot *slot, const TrianglePoint *point);
Vec2 slot_corner_uv(const Scene *scene, const TextureSlot *slot, uint32_t triangle, int corner);
