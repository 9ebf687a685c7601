/* SPDX-License-Identifier: Apache-2.0 */
/* Models, as .gltf or as .glb: what is loaded keeps what scene.h promises. */
#include <math.h>
#include <string.h>

#include "harness.h"
#include "scene/load/scene_load.h"

static bool is_id(int id, int count) {
    return id == NO_ID || (id >= 0 && id < count);
}

static bool all_finite(const float *value, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!isfinite(value[i])) return false;
    return true;
}

/* The vertices of a part's triangles are its own, and finite in all that is known of them. */
static void claim_attributes(const Scene *scene, const Part *part) {
    for (uint32_t i = 0; i < 3 * part->triangle_count; i++) {
        const Triangle *triangle = &scene->triangles[part->first_triangle + i / 3];
        fuzz_claim(triangle->vertex[i % 3] >= part->first_vertex, "a vertex is of its part");
        uint32_t v = triangle->vertex[i % 3] - part->first_vertex;
        fuzz_claim(!part->normals || all_finite(&part->normals[v].x, 3), "a normal is finite");
        fuzz_claim(!part->tangents || all_finite(&part->tangents[v].along.x, 3),
                   "a tangent is finite");
        for (int s = 0; s < SCENE_UV_SETS; s++)
            fuzz_claim(!part->uv[s] || all_finite(&part->uv[s][v].x, 2),
                       "texture coordinates are finite");
    }
}

static void claim_geometry(const Scene *scene) {
    fuzz_claim(scene->opaque_count <= scene->triangle_count, "opaque triangles are triangles");
    fuzz_claim(all_finite(&scene->positions[0].x, 3 * (size_t)scene->vertex_count),
               "positions are finite");
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const Triangle *triangle = &scene->triangles[t];
        for (int c = 0; c < 3; c++)
            fuzz_claim(triangle->vertex[c] < scene->vertex_count, "a triangle's vertex exists");
        fuzz_claim(triangle->part_id < (uint32_t)scene->part_count, "its part exists");
    }
    for (int p = 0; p < scene->part_count; p++) {
        const Part *part = &scene->parts[p];
        fuzz_claim(part->material_id >= 0 && part->material_id < scene->material_count,
                   "a part's material exists");
        fuzz_claim((uint64_t)part->first_triangle + part->triangle_count <= scene->triangle_count,
                   "a part's triangles exist");
        claim_attributes(scene, part);
    }
}

static void claim_slot(const Scene *scene, const TextureSlot *slot) {
    fuzz_claim(is_id(slot->texture_id, scene->texture_count), "a slot's texture exists");
    if (slot->texture_id == NO_ID) return;
    fuzz_claim(slot->uv_set >= 0 && slot->uv_set < SCENE_UV_SETS, "a slot's uv set exists");
    fuzz_claim(all_finite(slot->uv_from_uv, 6), "a slot's transform is finite");
}

static void claim_materials(const Scene *scene) {
    for (int i = 0; i < scene->material_count; i++) {
        const Material *m = &scene->materials[i];
        const TextureSlot *slots[] = {&m->base_color_texture,
                                      &m->metallic_roughness_texture,
                                      &m->normal_texture,
                                      &m->emissive_texture,
                                      &m->specular_texture,
                                      &m->specular_color_texture,
                                      &m->transmission_texture,
                                      &m->clearcoat_texture,
                                      &m->clearcoat_roughness_texture,
                                      &m->clearcoat_normal_texture};
        for (size_t s = 0; s < sizeof slots / sizeof *slots; s++) claim_slot(scene, slots[s]);
        fuzz_claim(all_finite(m->base_color, 4) && all_finite(m->emissive_cd_m2, 3) &&
                       isfinite(m->ior) && m->roughness >= 0 && m->roughness <= 1,
                   "a material is in range");
        fuzz_claim(is_id(m->display_id, scene->display_count), "a material's display exists");
        fuzz_claim(is_id(m->base_color_curve_id, scene->curve_count) &&
                       is_id(m->emission_curve_id, scene->curve_count),
                   "its curves exist");
    }
    for (int i = 0; i < scene->texture_count; i++)
        fuzz_claim(scene->textures[i].image.width > 0 && scene->textures[i].image.pixels,
                   "a texture has a picture");
}

static void claim_others(const Scene *scene) {
    for (int i = 0; i < scene->light_count; i++) {
        const PunctualLight *light = &scene->lights[i];
        fuzz_claim(all_finite(light->intensity, 3) && isfinite(light->position.x) &&
                       fabsf(vec3_dot(light->direction, light->direction) - 1) < 1e-3f,
                   "a light is finite and looks somewhere");
    }
    for (int i = 0; i < scene->camera_count; i++) {
        const SceneCamera *camera = &scene->cameras[i];
        fuzz_claim(camera->is_perspective ? camera->yfov > 0 : camera->ymag > 0,
                   "a camera sees something");
    }
    for (int i = 0; i < scene->display_count; i++)
        fuzz_claim(scene->displays[i].panel && scene->displays[i].level >= 0,
                   "a display has a panel");
}

void fuzz_scene(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Scene *scene;
    const char *path = fuzz_file("model.gltf", data, size, arena);
    Problems problems = problems_start(arena);
    SceneOptions options = {.paths = &path, .path_count = 1};
    if (!scene_load(&options, arena, &problems, &scene, &err)) {
        fuzz_claim_refusal(&err);
        fuzz_claim(problems.error_count > 0, "a refused model has an error in the list");
        return;
    }
    fuzz_claim(problems.error_count == 0, "a model with errors is refused");
    claim_geometry(scene);
    claim_materials(scene);
    claim_others(scene);
    scene_close(scene);
}
