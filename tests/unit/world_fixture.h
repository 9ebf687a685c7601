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
