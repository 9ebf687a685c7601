/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "scene/point/texture_slot.h"

Vec2 slot_uv(const TextureSlot *slot, const TrianglePoint *point) {
    return slot_from_uv(slot, point->uv[slot->uv_set]);
}

Vec2 slot_corner_uv(const Scene *scene, const TextureSlot *slot, uint32_t triangle, int corner) {
    return slot_from_uv(slot, scene_corner_uv(scene, triangle, corner, slot->uv_set));
}

bool point_tangent(const Scene *scene, uint32_t triangle, const TrianglePoint *point, Vec3 *along,
                   Vec3 *across) {
    const Tangent *tangents = scene_part(scene, triangle)->tangents;
    const float weight[3] = {1 - point->u - point->v, point->u, point->v};
    Vec3 n = point->ns;
    float side = 0;
    if (!tangents) return false;
    *along = vec3(0, 0, 0);
    for (int k = 0; k < 3; k++) {
        const Tangent *corner = &tangents[scene_corner_place(scene, triangle, k)];
        *along = vec3_along(*along, corner->along, weight[k]);
        side += weight[k] * corner->side;
    }
    *along = vec3_normalize(vec3_along(*along, n, -vec3_dot(*along, n)));
    *across = vec3_scale(vec3_cross(n, *along), side < 0 ? -1.0f : 1.0f);
    return vec3_dot(*along, *along) > 0.5f;
}

Vec3 mapped_normal(const Scene *scene, const TextureSlot *slot, Vec2 scale, uint32_t triangle,
                   const TrianglePoint *point) {
    float texel[4];
    Vec3 n = point->ns, along, across;
    if (slot->texture_id == NO_ID || !point_tangent(scene, triangle, point, &along, &across))
        return n;
    Vec2 uv = slot_uv(slot, point);
    texture_data(&scene->textures[slot->texture_id], uv.x, uv.y, texel);
    Vec3 bent = vec3_along(vec3_scale(along, scale.x * (2 * texel[0] - 1)), across,
                           scale.y * (2 * texel[1] - 1));
    bent = vec3_normalize(vec3_along(bent, n, 2 * texel[2] - 1));
    return vec3_dot(bent, bent) > 0.5f ? bent : n;
}

Vec3 coat_normal(const Scene *scene, const Material *material, uint32_t triangle,
                 const TrianglePoint *point) {
    return mapped_normal(scene, &material->clearcoat_normal_texture,
                         material->clearcoat_normal_scale, triangle, point);
}
