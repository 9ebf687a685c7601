/* SPDX-License-Identifier: Apache-2.0 */
/* world_fixture.h -- a scene made ready for paths, and what they find.
 *
 * Memory   world_end gives back all that world_start and world_ready took, and the panel.
 * Failure  world_ready fails the test.
 */
#pragma once
#include "fixture.h"

#include "panel/query/panel_open.h"
#include "path/path.h"
#include "scene_builder.h"

typedef struct World {
    Arena arena;
    Scene *scene;
    Panel *panel; /* of the display, if there is one */
    Bvh *bvh;
    PathContext context;
} World;

static inline World world_start(void) {
    World world = {.arena = arena_reserve((size_t)1 << 30)};
    world.scene = builder_scene(&world.arena);
    return world;
}

static inline void world_ready(World *world, int max_bounces) {
    Lights *lights;
    assert_done(bvh_create(world->scene, 1, NULL, &world->bvh, &err) &&
                lights_build(world->scene, &world->arena, &lights, &err));
    world->context =
        path_context_build(world->scene, world->bvh, lights, max_bounces, &world->arena);
}

static inline void world_end(World *world) {
    bvh_destroy(world->bvh);
    panel_close(world->panel);
    arena_release(&world->arena);
}

/* One that ends with its scope: SCOPED_WORLD world = world_start(). */
#define SCOPED_WORLD __attribute__((cleanup(world_end))) World

/* ---- displays ---------------------------------------------------------------------------- */

/* Starts a part that wears a new display of the world's panel, which it opens. */
static inline Display *world_display(World *world) {
    Scene *scene = world->scene;
    Material material = builder_material(0);
    int id = scene->display_count++;
    material.display_id = id;
    material.is_emitter = true;
    if (!world->panel)
        assert_done(panel_open(PROJECT_DIR "/assets/panels/ips_cluster.panel", &world->arena,
                               &world->panel, &err));
    scene->displays[id] = (Display){.name = "display",
                                    .panel = world->panel,
                                    .level = 1,
                                    .material_id = builder_part(scene, material),
                                    .content = builder_no_texture()};
    return &scene->displays[id];
}

/* ---- what paths find --------------------------------------------------------------------- */

typedef struct WorldMean {
    double mean, sigma, largest;
} WorldMean;

/* Rays through a square of side `spread` at distance 1 in the direction; or a luxmeter that
 * faces it. */
typedef struct Gauge {
    Vec3 from, direction;
    float spread;
    bool is_luxmeter;
} Gauge;

/* Luminance, cd m^-2, or illuminance, lx, by `count` paths. */
static inline WorldMean world_measure(const World *world, Gauge gauge, uint32_t seed, int count) {
    double sum = 0, squares = 0, largest = 0;
    Frame frame = frame_from_z(vec3_normalize(gauge.direction));
    LitPoint head = {gauge.from, gauge.direction, false};
    PathStatistics statistics = {0};
    PathContext context = world->context;
    if (gauge.is_luxmeter) context = path_context_of_meter(&context, head);
    for (int i = 0; i < count; i++) {
        Sampler sampler = sampler_start(seed, 0, 0, (uint32_t)i);
        Vec2 at = gauge.is_luxmeter ? (Vec2){0, 0} : sampler_2d(&sampler);
        Wavelengths w;
        PathResult result;
        wavelengths_sample(sampler_1d(&sampler), &w);
        PathStart start = {
            .context = &context, .wavelengths = &w, .sampler = &sampler, .statistics = &statistics};
        Vec3 local = vec3(gauge.spread * (at.x - 0.5f), gauge.spread * (at.y - 0.5f), 1);
        Ray ray = {gauge.from, vec3_normalize(frame_to_world(&frame, local)), 0, INFINITY};
        if (gauge.is_luxmeter) path_from_point(&start, head, result.xyz);
        else path_from_ray(&start, ray, &result);
        sum += (double)result.xyz[1];
        squares += (double)result.xyz[1] * (double)result.xyz[1];
        largest = fmax(largest, (double)result.xyz[1]);
    }
    double mean = sum / count;
    return (WorldMean){mean, sqrt(fmax(squares / count - mean * mean, 0) / count), largest};
}

/* From a point, in a pyramid that is `width` wide a metre away. */
typedef struct WorldLook {
    Vec3 from, direction;
    float width;
    uint32_t seed;
    int count; /* paths */
} WorldLook;

/* cd m^-2 */
static inline WorldMean world_luminance(const World *world, const WorldLook *look) {
    Gauge gauge = {look->from, look->direction, look->width, false};
    return world_measure(world, gauge, look->seed, look->count);
}
