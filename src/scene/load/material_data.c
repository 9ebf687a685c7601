/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/material_data.h"

#include "panel/query/panel_stated.h"

#define NAMES_LISTED 12
/* less is no lamp: exporters write ambient terms of old formats (AC3D, OBJ) as 0.03 to 0.21 */
#define LAMP_CD_M2 0.25f

static bool is_one(const float rgb[3]) {
    return rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1;
}

static bool has_colour(const Material *m) {
    return !is_one(m->base_color) || m->base_color_texture.texture_id != NO_ID ||
           m->base_color_curve_id != NO_ID || m->conductor;
}

static bool has_layer(const Material *m) {
    return m->coating || m->overlay || m->film || m->clearcoat > 0 ||
           m->specular_curve_id != NO_ID || m->specular_color_texture.texture_id != NO_ID ||
           !is_one(m->specular_color);
}

static bool lets_through(const Material *m) {
    return m->glazing || m->transmission > 0 || m->diffuse_transmission > 0 ||
           m->transmission_curve_id != NO_ID || m->index || m->base_color[3] < 1;
}

static bool is_lamp(const Material *m) {
    for (int c = 0; c < 3; c++)
        if (m->emissive_cd_m2[c] >= LAMP_CD_M2) return true;
    return m->emission_curve_id != NO_ID;
}

static bool has_data(const Material *m) {
    return m->display_id != NO_ID || m->unlit || is_lamp(m) || has_colour(m) || has_layer(m) ||
           lets_through(m);
}

/* Vertices without a colour of their own are white, as are those whose colour is white. */
static bool is_white(VertexColor color) {
    for (int c = 0; c < 4; c++)
        if (color.linear[c] != UINT16_MAX) return false;
    return true;
}

static bool is_coloured(const Scene *scene, const Part *part) {
    uint32_t end = part->colors ? part->first_triangle + part->triangle_count : 0;
    for (uint32_t t = part->first_triangle; t < end; t++)
        for (int k = 0; k < 3; k++)
            if (!is_white(part->colors[scene_corner_place(scene, t, k)])) return true;
    return false;
}

bool part_has_data(const Scene *scene, int part_id) {
    const Part *part = &scene->parts[part_id];
    return has_data(&scene->materials[part->material_id]) || is_coloured(scene, part);
}

int *scene_without_data(const Scene *scene, int *count, Arena *arena) {
    int *list = ARENA_NEW(arena, int, scene->material_count);
    bool *has_none = ARENA_NEW(arena, bool, scene->material_count);
    for (int i = 0; i < scene->part_count; i++)
        if (!part_has_data(scene, i)) has_none[scene->parts[i].material_id] = true;
    *count = 0;
    for (int i = 0; i < scene->material_count; i++)
        if (has_none[i]) list[(*count)++] = i;
    return list;
}

const char *scene_names_of(const Scene *scene, const int *materials, int count, Arena *arena) {
    const char *names = "";
    int listed = count <= NAMES_LISTED ? count : NAMES_LISTED - 1;
    for (int i = 0; i < listed; i++)
        names = arena_format(arena, "%s%s%s", names,
                             !i               ? ""
                             : i == count - 1 ? " and "
                                              : ", ",
                             scene->materials[materials[i]].name);
    return listed < count ? arena_format(arena, "%s and %d more", names, count - listed) : names;
}

const char *displays_assumed(const Scene *scene, Arena *arena) {
    const char *all = NULL;
    for (int i = 0; i < scene->display_count; i++) {
        const Display *display = &scene->displays[i];
        const char *words = panel_stated(display->panel, arena).assumed;
        if (words) all = arena_format(arena, "%s%s: %s\n", all ? all : "", display->name, words);
    }
    return all;
}
