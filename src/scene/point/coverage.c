/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/point/coverage.h"

bool vertex_color(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                  float rgba[4]) {
    const VertexColor *colors = scene_part(scene, triangle)->colors;
    const float weight[3] = {1 - point->u - point->v, point->u, point->v};
    if (!colors) return false;
    for (int i = 0; i < 4; i++) {
        float colour = 0;
        for (int k = 0; k < 3; k++)
            colour += weight[k] * (float)colors[scene_corner_place(scene, triangle, k)].linear[i];
        rgba[i] = colour * (1.0f / 65535);
    }
    return true;
}

void coverage_texel(const Scene *scene, const Material *material, const Hit *hit,
                    const TrianglePoint *point, float texel[4]) {
    const TextureSlot *slot = &material->base_color_texture;
    float color[4];
    texel[0] = texel[1] = texel[2] = texel[3] = 1;
    if (slot->texture_id != NO_ID) {
        Vec2 uv = slot_uv(slot, point);
        texture_colour(&scene->textures[slot->texture_id], uv.x, uv.y, texel);
    }
    if (!vertex_color(scene, hit->triangle, point, color)) return;
    for (int i = 0; i < 4; i++) texel[i] *= color[i];
}

float coverage_alpha(const Material *material, float texel_alpha) {
    float alpha = material->base_color[3] * texel_alpha;
    switch (material->alpha_mode) {
    case ALPHA_OPAQUE: return 1;
    case ALPHA_MASK: return alpha >= material->alpha_cutoff ? 1 : 0;
    case ALPHA_BLEND: return clampf(alpha, 0, 1);
    }
    return 1;
}

float coverage_at(const Scene *scene, const Hit *hit, const TrianglePoint *point) {
    const Material *material = &scene->materials[scene_part(scene, hit->triangle)->material_id];
    float texel[4];
    if (material->alpha_mode == ALPHA_OPAQUE) return 1;
    coverage_texel(scene, material, hit, point, texel);
    return coverage_alpha(material, texel[3]);
}
