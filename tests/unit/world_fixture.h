/* SPDX-License-Identifier: Apache-2.0 */
/* world_fixture.h -- a scene made ready for paths.
 *
 * Memory   world_end gives back all that world_start and world_ready took, and the panel.
 * Failure  world_ready fails the test.
 */
#pragma once
#include "check.h"

#include "panel/query/panel_open.h"
#include "path/path.h"
#include "scene_builder.h"

typedef struct World {
    Arena       arena;
    Scene      *scene;
    Panel      *panel; /* of the display, if there is one */
    Bvh        *bvh;
    PathContext context;
} World;

static inline World world_start(void)
{
    World world = {.arena = arena_reserve((size_t)1 << 30)};
    world.scene = builder_scene(&world.arena);
    return world;
}

static inline void world_ready(World *world, int max_bounces)
{
    Error   err = {0};
    Lights *lights;
    if (!bvh_create(world->scene, 1, NULL, &world->bvh, &err)) fail_msg("%s", err.text);
    if (!lights_build(world->scene, &world->arena, &lights, &err)) fail_msg("%s", err.text);
    world->context =
        path_context_build(world->scene, world->bvh, lights, max_bounces, &world->arena);
}

static inline void world_end(World *world)
{
    bvh_destroy(world->bvh);
    panel_close(world->panel);
    arena_release(&world->arena);
}

/* One that ends with its scope: SCOPED_WORLD world = world_start(). */
#define SCOPED_WORLD __attribute__((cleanup(world_end))) World

/* ---- what is seen of it ------------------------------------------------------------------ */

/* From a point, in a pyramid that is `width` wide a metre away. */
typedef struct WorldLook {
    Vec3     from, direction;
    float    width;
    uint32_t seed;
    int      count; /* paths */
} WorldLook;

typedef struct WorldMean {
    double mean, sigma; /* of the mean */
} WorldMean;

/* cd m^-2 */
static inline WorldMean world_luminance(const World *world, const WorldLook *look)
{
    double sum = 0, squares = 0;
    Frame  frame = frame_from_z(vec3_normalize(look->direction));
    PathStatistics statistics = {0};
    for (int i = 0; i < look->count; i++) {
        Sampler sampler = sampler_start(look->seed, 0, 0, (uint32_t)i);
        Vec2    at = sampler_2d(&sampler);
        Wavelengths w;
        PathResult  result;
        wavelengths_sample(sampler_1d(&sampler), &w);
        Vec3 local = vec3(look->width * (at.x - 0.5f), look->width * (at.y - 0.5f), 1);
        Ray  ray = {look->from, vec3_normalize(frame_to_world(&frame, local)), 0, INFINITY};
        PathStart start = {.context = &world->context, .wavelengths = &w, .sampler = &sampler,
                           .statistics = &statistics};
        path_from_ray(&start, ray, &result);
        sum += (double)result.xyz[1];
        squares += (double)result.xyz[1] * (double)result.xyz[1];
    }
    double mean = sum / look->count;
    return (WorldMean){mean, sqrt(fmax(squares / look->count - mean * mean, 0) / look->count)};
}
