/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/material_list.h"

#include <string.h>

#include "print/print.h"
#include "text/json_text.h"

/* The nodes, meshes and areas of one material. */
typedef struct MaterialUse {
    const char **nodes, **meshes; /* each name once */
    int node_count, mesh_count;
    double area_m2, uv_area_m2; /* the latter: where texture coordinates span an area */
    bool is_flat;               /* each of its parts is */
} MaterialUse;

/* ---- geometry --------------------------------------------------------------------------- */

static bool has_coordinates(const Scene *scene, uint32_t triangle, int set) {
    Vec2 uv[3];
    for (int i = 0; i < 3; i++) uv[i] = scene_corner_uv(scene, triangle, i, set);
    float u1 = uv[1].x - uv[0].x, v1 = uv[1].y - uv[0].y;
    float u2 = uv[2].x - uv[0].x, v2 = uv[2].y - uv[0].y;
    return fabsf(u1 * v2 - u2 * v1) > 0;
}

/* A part is flat when its areas, added as vectors, are as long as their sum: within 1 %, which
 * is a bulge of some 8 degrees to all sides. */
#define FLAT_SHARE 0.99

static void add_part(const Scene *scene, const Part *part, MaterialUse *use) {
    Vec3 sum = vec3(0, 0, 0);
    double area = 0;
    int set = scene->materials[part->material_id].emissive_texture.uv_set;
    for (uint32_t i = 0; i < part->triangle_count; i++) {
        uint32_t t = part->first_triangle + i;
        Vec3 a = scene_corner(scene, t, 0);
        Vec3 twice = vec3_cross(vec3_sub(scene_corner(scene, t, 1), a),
                                vec3_sub(scene_corner(scene, t, 2), a));
        double own = 0.5 * (double)vec3_length(twice);
        sum = vec3_along(sum, twice, 0.5f);
        area += own;
        if (has_coordinates(scene, t, set)) use->uv_area_m2 += own;
    }
    use->area_m2 += area;
    if ((double)vec3_length(sum) < FLAT_SHARE * area) use->is_flat = false;
}

/* ---- names ------------------------------------------------------------------------------ */

static void add_name(const char **names, int *count, const char *name) {
    for (int i = 0; i < *count; i++)
        if (!strcmp(names[i], name)) return;
    if (name[0]) names[(*count)++] = name;
}

static int parts_of(const Scene *scene, int material_id) {
    int count = 0;
    for (int i = 0; i < scene->part_count; i++) count += scene->parts[i].material_id == material_id;
    return count;
}

static MaterialUse use_of(const Scene *scene, int material_id, Arena *arena) {
    int parts = parts_of(scene, material_id);
    MaterialUse use = {.nodes = ARENA_NEW(arena, const char *, parts),
                       .meshes = ARENA_NEW(arena, const char *, parts),
                       .is_flat = parts > 0};
    for (int i = 0; i < scene->part_count; i++) {
        const Part *part = &scene->parts[i];
        if (part->material_id != material_id) continue;
        add_name(use.nodes, &use.node_count, part->node_name);
        add_name(use.meshes, &use.mesh_count, part->mesh_name);
        add_part(scene, part, &use);
    }
    return use;
}

/* ---- is it a screen? -------------------------------------------------------------------- */

static bool glows_with_texture(const Scene *scene, int material_id) {
    return scene->materials[material_id].emissive_texture.texture_id != NO_ID;
}

static bool has_uv(const MaterialUse *use) {
    return use->area_m2 > 0 && use->uv_area_m2 > 0.9 * use->area_m2;
}

/* Modellers put a screen into a model as a flat sheet that glows with a picture. */
static bool looks_like_screen(const Scene *scene, int material_id, const MaterialUse *use) {
    return glows_with_texture(scene, material_id) && use->is_flat && has_uv(use);
}

/* ---- its back --------------------------------------------------------------------------- */

/* A display has a back of its own, a black casing. */
static bool is_one_sided(const Scene *scene, int material_id) {
    const Material *m = &scene->materials[material_id];
    return !m->double_sided && m->display_id == NO_ID && parts_of(scene, material_id) > 0;
}

/* ---- answers ---------------------------------------------------------------------------- */

json_t *material_list_json(const Scene *scene, Arena *arena) {
    json_t *list = json_array();
    for (int i = 0; i < scene->material_count; i++) {
        Arena scratch = *arena;
        const MaterialUse use = use_of(scene, i, &scratch);
        json_array_append_new(list, json_pack("{s:o, s:o, s:o, s:f, s:b, s:b, s:b, s:b, s:b, s:b}",
                                              "name", json_text(scene->materials[i].name), "meshes",
                                              json_texts(use.meshes, use.mesh_count), "nodes",
                                              json_texts(use.nodes, use.node_count), "area_m2",
                                              use.area_m2, "looks_like_screen",
                                              looks_like_screen(scene, i, &use),
                                              "has_emissive_texture", glows_with_texture(scene, i),
                                              "is_flat", use.is_flat, "has_uv", has_uv(&use),
                                              "is_display", scene->materials[i].display_id != NO_ID,
                                              "is_one_sided", is_one_sided(scene, i)));
    }
    return list;
}

json_t *material_list_one_sided(const Scene *scene) {
    json_t *list = json_array();
    for (int i = 0; i < scene->material_count; i++)
        if (is_one_sided(scene, i))
            json_array_append_new(list, json_text(scene->materials[i].name));
    return list;
}
