/* SPDX-License-Identifier: Apache-2.0 */
/* scene_builder.h -- small scenes made in code, for tests of what stands above the scene. */
#pragma once
#include <math.h>
#include <string.h>

#include "scene/scene.h"

#define BUILDER_VERTICES 200000
#define BUILDER_TRIANGLES 200000
#define BUILDER_PARTS 64

static inline TextureSlot builder_no_texture(void) {
    return (TextureSlot){.texture_id = NO_ID, .uv_from_uv = {1, 0, 0, 0, 1, 0}};
}

/* glTF's default material, made rough, white and non-metallic. */
static inline Material builder_material(float albedo) {
    TextureSlot none = builder_no_texture();
    return (Material){.name = "test",
                      .base_color = {albedo, albedo, albedo, 1},
                      .base_color_texture = none,
                      .metallic = 0,
                      .roughness = 1,
                      .metallic_roughness_texture = none,
                      .normal_texture = none,
                      .normal_scale = {1, 1},
                      .emissive_texture = none,
                      .alpha_cutoff = 0.5f,
                      .ior = 1.5f,
                      .specular = 0,
                      .specular_texture = none,
                      .specular_color = {1, 1, 1},
                      .specular_color_texture = none,
                      .transmission_texture = none,
                      .clearcoat_texture = none,
                      .clearcoat_roughness_texture = none,
                      .clearcoat_normal_texture = none,
                      .clearcoat_normal_scale = {1, 1},
                      .attenuation_color = {1, 1, 1},
                      .attenuation_distance_m = INFINITY,
                      .display_id = NO_ID,
                      .base_color_curve_id = NO_ID,
                      .specular_curve_id = NO_ID,
                      .transmission_curve_id = NO_ID,
                      .emission_curve_id = NO_ID};
}

/* Black, of its own light. */
static inline Material builder_lamp(float cd_m2) {
    Material material = builder_material(0);
    material.is_emitter = true;
    for (int i = 0; i < 3; i++) material.emissive_cd_m2[i] = cd_m2;
    return material;
}

/* Metal without a colour of its own, as smooth as the product has it. */
static inline Material builder_mirror(float reflectance) {
    Material material = builder_material(reflectance);
    material.metallic = 1;
    material.roughness = 0;
    return material;
}

/* A thin pane without colour. */
static inline Material builder_pane(float ior) {
    Material material = builder_material(1);
    material.transmission = 1;
    material.roughness = 0;
    material.ior = ior;
    material.lets_light_through = true;
    return material;
}

static inline Scene *builder_scene(Arena *arena) {
    Scene *scene = ARENA_NEW(arena, Scene, 1);
    scene->positions = ARENA_NEW(arena, Vec3, BUILDER_VERTICES);
    scene->triangles = ARENA_NEW(arena, Triangle, BUILDER_TRIANGLES);
    scene->parts = ARENA_NEW(arena, Part, BUILDER_PARTS);
    scene->parts[0].normals = ARENA_NEW(arena, Vec3, BUILDER_VERTICES);
    for (int s = 0; s < SCENE_UV_SETS; s++)
        scene->parts[0].uv[s] = ARENA_NEW(arena, Vec2, BUILDER_VERTICES);
    scene->materials = ARENA_NEW(arena, Material, BUILDER_PARTS);
    scene->lights = ARENA_NEW(arena, PunctualLight, BUILDER_PARTS);
    scene->displays = ARENA_NEW(arena, Display, BUILDER_PARTS);
    scene->textures = ARENA_NEW(arena, Texture, BUILDER_PARTS);
    scene->environment.forward = vec3(0, 0, -1);
    scene->environment.sun_angular_radius = 0.0046504f;
    scene->bounds_min = vec3(INFINITY, INFINITY, INFINITY);
    scene->bounds_max = vec3(-INFINITY, -INFINITY, -INFINITY);
    return scene;
}

/* Surroundings that are white and equally bright everywhere. */
static inline void builder_sky(Scene *scene, float cd_m2) {
    scene->environment.kind = ENVIRONMENT_CONSTANT;
    scene->environment.luminance_cd_m2 = cd_m2;
    for (int i = 0; i < 3; i++) scene->environment.color[i] = 1;
}

/* Angles in radians. */
static inline void builder_sun(Scene *scene, double azimuth, double elevation, float lx) {
    scene->environment.has_sun = true;
    scene->environment.sun_azimuth = (float)azimuth;
    scene->environment.sun_elevation = (float)elevation;
    scene->environment.sun_illuminance_lx = lx;
}

/* Starts a part with a material; triangles that follow belong to it. Opaque parts come first.
 * All parts share the arrays of the first. */
static inline int builder_part(Scene *scene, Material material) {
    int id = scene->material_count++;
    scene->materials[id] = material;
    Part *part = &scene->parts[scene->part_count++];
    *part = scene->parts[0];
    part->name = "part";
    part->material_id = id;
    part->first_triangle = scene->triangle_count;
    part->triangle_count = 0;
    return id;
}

static inline uint32_t builder_vertex(Scene *scene, Vec3 p, Vec3 n, float u, float v) {
    const Part *part = &scene->parts[0];
    scene->positions[scene->vertex_count] = p;
    part->normals[scene->vertex_count] = n;
    part->uv[0][scene->vertex_count] = part->uv[1][scene->vertex_count] = (Vec2){u, v};
    scene->bounds_min = vec3(fminf(scene->bounds_min.x, p.x), fminf(scene->bounds_min.y, p.y),
                             fminf(scene->bounds_min.z, p.z));
    scene->bounds_max = vec3(fmaxf(scene->bounds_max.x, p.x), fmaxf(scene->bounds_max.y, p.y),
                             fmaxf(scene->bounds_max.z, p.z));
    return scene->vertex_count++;
}

static inline void builder_triangle(Scene *scene, uint32_t a, uint32_t b, uint32_t c) {
    Part *part = &scene->parts[scene->part_count - 1];
    uint32_t id = scene->triangle_count++;
    scene->triangles[id] = (Triangle){{a, b, c}, (uint32_t)(scene->part_count - 1)};
    for (int k = 0; k < 3; k++) {
        Vec3 edge = vec3_sub(scene_corner(scene, id, (k + 1) % 3), scene_corner(scene, id, k));
        scene->longest_edge_m = fmaxf(scene->longest_edge_m, vec3_length(edge));
    }
    part->triangle_count++;
    if (!scene->materials[part->material_id].lets_light_through)
        scene->opaque_count = scene->triangle_count;
}

/* A parallelogram centre +- half_u +- half_v, its front where half_u x half_v points; u grows
 * along half_u, v shrinks along half_v (a picture stands upright). */
static inline void builder_quad(Scene *scene, Vec3 centre, Vec3 half_u, Vec3 half_v) {
    Vec3 n = vec3_normalize(vec3_cross(half_u, half_v));
    uint32_t first = scene->vertex_count;
    for (int i = 0; i < 4; i++) {
        float s = i == 0 || i == 3 ? -1.0f : 1.0f, t = i < 2 ? -1.0f : 1.0f;
        builder_vertex(scene, vec3_along(vec3_along(centre, half_u, s), half_v, t), n,
                       0.5f + 0.5f * s, 0.5f - 0.5f * t);
    }
    builder_triangle(scene, first, first + 1, first + 2);
    builder_triangle(scene, first, first + 2, first + 3);
}

/* A sphere of 2 * rings * rings * 2 triangles; outward front, or inward when inside is set. */
static inline void builder_sphere(Scene *scene, Vec3 centre, float radius, int rings, int inside) {
    uint32_t first = scene->vertex_count;
    int columns = 2 * rings;
    float flip = inside ? -1.0f : 1.0f;
    for (int j = 0; j <= rings; j++)
        for (int i = 0; i <= columns; i++) {
            double theta = 3.14159265358979 * j / rings, phi = 6.28318530717959 * i / columns;
            Vec3 n = vec3((float)(sin(theta) * cos(phi)), (float)cos(theta),
                          (float)(-sin(theta) * sin(phi)));
            builder_vertex(scene, vec3_along(centre, n, radius), vec3_scale(n, flip),
                           (float)i / (float)columns, (float)j / (float)rings);
        }
    for (int j = 0; j < rings; j++)
        for (int i = 0; i < columns; i++) {
            uint32_t a = first + (uint32_t)(j * (columns + 1) + i), b = a + (uint32_t)columns + 1;
            if (j > 0) builder_triangle(scene, a, inside ? a + 1 : b, inside ? b : a + 1);
            if (j < rings - 1)
                builder_triangle(scene, a + 1, inside ? b + 1 : b, inside ? b : b + 1);
        }
}

/* A piece of the unit sphere, 0.1 radians wide, about n. */
static inline void builder_cap(Scene *scene, Vec3 n) {
    enum { SIDE = 64 };
    Frame frame = frame_from_z(n);
    uint32_t first = scene->vertex_count;
    for (int j = 0; j <= SIDE; j++)
        for (int i = 0; i <= SIDE; i++) {
            Vec3 local = vec3(0.1f * ((float)i / SIDE - 0.5f), 0.1f * ((float)j / SIDE - 0.5f), 1);
            Vec3 at = vec3_normalize(frame_to_world(&frame, local));
            builder_vertex(scene, at, at, 0, 0);
        }
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++) {
            uint32_t a = first + j * (SIDE + 1) + i, b = a + SIDE + 1;
            builder_triangle(scene, a, a + 1, b + 1);
            builder_triangle(scene, a, b + 1, b);
        }
}
