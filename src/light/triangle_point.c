/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "light/triangle_point.h"

static Vec3 interpolate(Vec3 a, Vec3 b, Vec3 c, float u, float v)
{
    float w = 1 - u - v;
    return vec3(w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y,
                w * a.z + u * b.z + v * c.z);
}

Vec3 triangle_position(const Scene *scene, uint32_t triangle, float u, float v)
{
    const uint32_t *vertex = scene->triangles[triangle].vertex;
    return interpolate(scene->positions[vertex[0]], scene->positions[vertex[1]],
                       scene->positions[vertex[2]], u, v);
}

TrianglePoint triangle_point(const Scene *scene, uint32_t triangle, float u, float v)
{
    const Triangle *t = &scene->triangles[triangle];
    const Part *part = &scene->parts[t->part_id];
    Vec3  a = scene->positions[t->vertex[0]], b = scene->positions[t->vertex[1]],
          c = scene->positions[t->vertex[2]];
    uint32_t i = t->vertex[0] - part->first_vertex, j = t->vertex[1] - part->first_vertex,
             k = t->vertex[2] - part->first_vertex;
    TrianglePoint point = {.position = interpolate(a, b, c, u, v), .u = u, .v = v};
    point.ng = vec3_normalize(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
    point.ns = part->normals ? vec3_normalize(interpolate(part->normals[i], part->normals[j],
                                                          part->normals[k], u, v))
                             : point.ng;
    if (!(vec3_dot(point.ns, point.ns) > 0.5f)) point.ns = point.ng;
    for (int set = 0; set < SCENE_UV_SETS; set++) {
        const Vec2 *uv = part->uv[set];
        float w = 1 - u - v;
        if (uv)
            point.uv[set] = (Vec2){w * uv[i].x + u * uv[j].x + v * uv[k].x,
                                   w * uv[i].y + u * uv[j].y + v * uv[k].y};
    }
    return point;
}

static Vec2 slot_from_uv(const TextureSlot *slot, Vec2 uv)
{
    const float *m = slot->uv_from_uv;
    return (Vec2){m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
}

Vec2 slot_uv(const TextureSlot *slot, const TrianglePoint *point)
{
    return slot_from_uv(slot, point->uv[slot->uv_set]);
}

Vec2 slot_corner_uv(const Scene *scene, const TextureSlot *slot, uint32_t triangle, int corner)
{
    return slot_from_uv(slot, scene_corner_uv(scene, triangle, corner, slot->uv_set));
}
