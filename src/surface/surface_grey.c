/* SPDX-License-Identifier: Apache-2.0 */
#include "surface/surface_grey.h"

#include "panel/query/panel_place.h"
#include "panel/query/panel_reflection.h"

static bool is_grey(const float rgb[3]) {
    return rgb[0] == rgb[1] && rgb[1] == rgb[2];
}

static bool is_level(const Curve *curve) {
    for (int i = 1; curve && i < CURVE_COUNT; i++)
        if (curve->value[i] != curve->value[0]) return false;
    return true;
}

static bool is_level_id(const Scene *scene, int curve_id) {
    return curve_id == NO_ID || is_level(&scene->curves[curve_id]);
}

/* Equal codes are equal in every step from code to texel. */
#define PIXELS_ARE_GREY(Type) \
    for (size_t i = 0; i < count; i++) { \
        const Type *p = (const Type *)image->pixels + 4 * i; \
        if (p[0] != p[1] || p[1] != p[2]) return false; \
    } \
    return true

static bool image_is_grey(const Image *image) {
    size_t count = (size_t)image->width * (size_t)image->height;
    switch (image->format) {
    case IMAGE_RGBA8: PIXELS_ARE_GREY(uint8_t);
    case IMAGE_RGBA16: PIXELS_ARE_GREY(uint16_t);
    case IMAGE_RGBA32F: PIXELS_ARE_GREY(float);
    }
    return false;
}

static bool slot_is_grey(const Scene *scene, const TextureSlot *slot) {
    return slot->texture_id == NO_ID || image_is_grey(&scene->textures[slot->texture_id].image);
}

static bool display_is_grey(const Scene *scene, const Material *m) {
    const Panel *panel = scene->displays[m->display_id].panel;
    return !m->coating && !panel_varies(panel) && panel_reflects_grey(panel);
}

static bool glazing_is_grey(const Glazing *pane) {
    return is_level(&pane->absorbance) && !pane->coating[0] && !pane->coating[1];
}

static bool layers_are_grey(const Scene *scene, const Material *m) {
    const MaterialOverlay *overlay = m->overlay;
    return !m->coating && !m->film && !m->index &&
           (!m->conductor || (is_level(&m->conductor->n) && is_level(&m->conductor->k))) &&
           (!overlay || (is_grey(overlay->color) && slot_is_grey(scene, &overlay->color_texture)));
}

static bool colours_are_grey(const Scene *scene, const Material *m) {
    return is_grey(m->base_color) && is_grey(m->specular_color) &&
           is_grey(m->diffuse_transmission_color) && is_grey(m->attenuation_color) &&
           is_level_id(scene, m->base_color_curve_id) && is_level_id(scene, m->specular_curve_id) &&
           is_level_id(scene, m->transmission_curve_id) &&
           slot_is_grey(scene, &m->base_color_texture) &&
           slot_is_grey(scene, &m->specular_color_texture) &&
           slot_is_grey(scene, &m->diffuse_transmission_color_texture);
}

static bool material_is_grey(const Scene *scene, const Material *m) {
    if (m->display_id != NO_ID) return display_is_grey(scene, m);
    if (m->glazing) return glazing_is_grey(m->glazing);
    return m->unlit || (layers_are_grey(scene, m) && colours_are_grey(scene, m));
}

static bool vertices_are_grey(const Scene *scene, const Part *part) {
    uint32_t end = part->colors ? part->first_triangle + part->triangle_count : 0;
    for (uint32_t t = part->first_triangle; t < end; t++) {
        for (int k = 0; k < 3; k++) {
            const uint16_t *c = part->colors[scene_corner_place(scene, t, k)].linear;
            if (c[0] != c[1] || c[1] != c[2]) return false;
        }
    }
    return true;
}

const bool *surface_grey_build(const Scene *scene, Arena *arena) {
    bool *grey = ARENA_NEW(arena, bool, scene->material_count + 1);
    for (int i = 0; i < scene->material_count; i++)
        grey[i] = material_is_grey(scene, &scene->materials[i]);
    for (int i = 0; i < scene->part_count; i++)
        if (!vertices_are_grey(scene, &scene->parts[i])) grey[scene->parts[i].material_id] = false;
    return grey;
}
