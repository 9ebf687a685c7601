/* SPDX-License-Identifier: Apache-2.0 */
/* What the sun lights, sampled from its side. */
#include "base/units.h"
#include "path/sunlit.h"
#include "sunlit/sunlit_build.h"
#include "world_fixture.h"

/* A room of 1.2 x 1 x 1 m, its floor pale, with a hole in the ceiling; a camera looks at
 * the wall z = 0. */
typedef struct Room {
    float hole, walls, floor;
    float gap; /* of a slit: the hole's other side; 0: it is a square */
    int threads;
} Room;

#define SUN_LX 90000.0
#define WIDE 1.2f
#define DEEP 1.01f

static const double SUN_UP = 62, SUN_AT = 165; /* degrees */
static const float HOLE_X = 0.25f, HOLE_Z = 0.9f;

static void ceiling(Scene *scene, float x0, float x1, float z0, float z1) {
    builder_quad(scene, vec3((x0 + x1) / 2, 1, (z0 + z1) / 2), vec3((x1 - x0) / 2, 0, 0),
                 vec3(0, 0, (z1 - z0) / 2));
}

static float gap_of(const Room *room) {
    return room->gap > 0 ? room->gap : room->hole;
}

static void build_room(Scene *scene, const Room *room) {
    float a = room->hole / 2, b = gap_of(room) / 2;
    builder_part(scene, builder_material(room->floor));
    builder_quad(scene, vec3(WIDE / 2, 0, DEEP / 2), vec3(WIDE / 2, 0, 0), vec3(0, 0, -DEEP / 2));
    builder_part(scene, builder_material(room->walls));
    ceiling(scene, 0, HOLE_X - a, 0, DEEP);
    ceiling(scene, HOLE_X + a, WIDE, 0, DEEP);
    ceiling(scene, HOLE_X - a, HOLE_X + a, 0, HOLE_Z - b);
    ceiling(scene, HOLE_X - a, HOLE_X + a, HOLE_Z + b, DEEP);
    builder_quad(scene, vec3(WIDE / 2, 0.5f, 0), vec3(WIDE / 2, 0, 0), vec3(0, 0.5f, 0));
    builder_quad(scene, vec3(WIDE / 2, 0.5f, DEEP), vec3(-WIDE / 2, 0, 0), vec3(0, 0.5f, 0));
    builder_quad(scene, vec3(0, 0.5f, DEEP / 2), vec3(0, 0, -DEEP / 2), vec3(0, 0.5f, 0));
    builder_quad(scene, vec3(WIDE, 0.5f, DEEP / 2), vec3(0, 0, DEEP / 2), vec3(0, 0.5f, 0));
    builder_sun(scene, radians_from_degrees(SUN_AT), radians_from_degrees(SUN_UP), (float)SUN_LX);
}

static World room_world(const Room *room) {
    World world = world_start();
    Scene *scene = world.scene;
    build_room(scene, room);
    scene->cameras = ARENA_NEW(&world.arena, SceneCamera, 1);
    scene->camera_count = 1;
    scene->cameras[0] = (SceneCamera){.is_perspective = true,
                                      .yfov = 1.2f,
                                      .aspect = 1.5f,
                                      .world_from_camera = transform_identity()};
    scene->cameras[0].world_from_camera.origin = vec3(0.6f, 0.5f, 0.9f);
    Lights *lights;
    assert_done(bvh_create(scene, room->threads ? room->threads : 1, NULL, &world.bvh, &err) &&
                lights_build(scene, &world.arena, &lights, &err));
    world.context = path_context_build(scene, world.bvh, lights, 16, &world.arena);
    return world;
}

/* Of the patch under the hole, by its luminance and form factor. */
static double patch_lx(const Room *room, Vec3 at) {
    enum { SIDE = 32 };
    double up = radians_from_degrees(SUN_UP), az = radians_from_degrees(SUN_AT);
    double s[3] = {sin(az) * cos(up), sin(up), -cos(az) * cos(up)}, sum = 0;
    double dx = (double)room->hole / SIDE, dz = (double)gap_of(room) / SIDE;
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            double x = (double)HOLE_X + dx * (i + 0.5 - SIDE / 2) - s[0] / s[1];
            double z = (double)HOLE_Z + dz * (j + 0.5 - SIDE / 2) - s[2] / s[1];
            double d[3] = {x - (double)at.x, -(double)at.y, z - (double)at.z};
            double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            sum += d[2] * -d[1] / (d2 * d2) * dx * dz;
        }
    return sum * SUN_LX * s[1] * (double)room->floor / PI;
}

/* Today's chance finds it once in 100 to 14,000 paths. */
TEST(a_patch_of_sun_lights_a_wall_as_its_form_factor_says) {
    const float holes[] = {0.005f, 0.015f, 0.06f, 0.12f};
    for (int i = 0; i < 4; i++) {
        const Room room = {.hole = holes[i], .floor = 0.8f};
        SCOPED_WORLD world = room_world(&room);
        Gauge head = {vec3(0.6f, 0.45f, 0.002f), vec3(0, 0, 1), 0, true};
        WorldMean found = world_measure(&world, head, 7, 1 << 15);
        double truth = patch_lx(&room, head.from);
        assert_true(found.sigma < 0.02 * truth);
        assert_true(fabs(found.mean - truth) < 4 * found.sigma + 1e-3 * truth);
    }
}

/* One of the first rays in seven comes in by the slit: what is looked at about those leaves
 * gaps between them. */
TEST(a_slit_narrower_than_a_pixel_is_followed_to_its_ends) {
    const Room room = {.hole = 0.2f, .gap = 0.0004f, .floor = 0.8f};
    SCOPED_WORLD world = room_world(&room);
    Gauge head = {vec3(0.6f, 0.45f, 0.002f), vec3(0, 0, 1), 0, true};
    WorldMean found = world_measure(&world, head, 7, 1 << 16);
    double truth = patch_lx(&room, head.from);
    assert_true(found.sigma < 0.02 * truth);
    assert_true(fabs(found.mean - truth) < 4 * found.sigma + 1e-3 * truth);
}

/* Where chance finds enough, too, both agree. */
TEST(with_and_without_the_map_the_mean_is_the_same) {
    const Room room = {.hole = 0.4f, .walls = 0.5f, .floor = 0.8f};
    SCOPED_WORLD world = room_world(&room), bare = room_world(&room);
    assert_non_null(world.context.sunlit.nodes);
    bare.context.sunlit.nodes = NULL;
    for (int k = 0; k < 3; k++) {
        Gauge head = {vec3(0.3f + 0.3f * (float)k, 0.2f, 0.3f), vec3(0, 0, 1), 0, true};
        WorldMean a = world_measure(&world, head, 11, 1 << 16);
        WorldMean b = world_measure(&bare, head, 12, 1 << 16);
        assert_true(fabs(a.mean - b.mean) < 4 * hypot(a.sigma, b.sigma));
        assert_true(a.sigma < b.sigma);
    }
}

/* ---- the map ----------------------------------------------------------------------------- */

static LitPoint any_point(Sampler *sampler) {
    Vec2 a = sampler_2d(sampler), b = sampler_2d(sampler);
    Vec3 n = vec3_normalize(vec3(b.x - 0.5f, b.y - 0.3f, a.x - 0.4f));
    return (LitPoint){vec3(0.1f + a.x, 0.1f + 0.8f * a.y, 0.1f + 0.8f * b.x), n, b.y < 0.3f};
}

TEST(a_chosen_ray_has_the_density_that_its_places_are_given) {
    const Room room = {.hole = 0.06f, .floor = 0.8f};
    SCOPED_WORLD world = room_world(&room);
    const SunlitMap *map = &world.context.sunlit;
    int chosen = 0, alike = 0;
    for (uint32_t i = 0; i < 5000; i++) {
        Sampler sampler = sampler_start(3, 0, 0, i);
        LitPoint from = any_point(&sampler);
        float u[4], length;
        SunlitRay ray;
        LightSample sun;
        sampler_4d(&sampler, u);
        assert_true(lights_sample(world.context.lights, LIGHTS_SUN, from, u, &sun));
        sampler_4d(&sampler, u);
        if (!sunlit_map_choose(map, &from, u, &ray)) continue;
        Vec3 entry = sunlit_map_entry(map, &ray, sun.wi, &length);
        Vec3 place = vec3_along(entry, sun.wi, -length * (0.01f + 0.98f * u[3]));
        float density = sunlit_map_density(map, &from, place, sun.wi);
        /* beside a leaf's edge rounding may choose the next one's */
        alike += fabsf(density / ray.density - 1) < 1e-4f;
        chosen++;
    }
    assert_true(chosen > 1000);
    assert_true(alike > 0.98 * chosen);
}

/* Counts in blocks of the square against the density's integral there: chi-square. */
TEST(rays_are_chosen_as_the_density_says) {
    enum { BLOCKS = 16, RAYS = 1 << 17, GRID = 1024 };
    const Room room = {.hole = 0.12f, .floor = 0.8f};
    SCOPED_WORLD world = room_world(&room);
    const SunlitMap *map = &world.context.sunlit;
    LitPoint from = {vec3(0.6f, 0.45f, 0.01f), vec3(0, 0, 1), false};
    double *expected = ARENA_NEW(&world.arena, double, BLOCKS *BLOCKS), sum = 0, chi2 = 0;
    int *count = ARENA_NEW(&world.arena, int, BLOCKS *BLOCKS), freedom = -1;
    float step = map->side / GRID;
    for (int j = 0; j < GRID; j++)
        for (int i = 0; i < GRID; i++) {
            Vec3 at = vec3_add(map->corner,
                               frame_to_world(&map->frame, vec3(((float)i + 0.5f) * step,
                                                                ((float)j + 0.5f) * step, 0)));
            double p = (double)(sunlit_map_density(map, &from, at, map->frame.z) * step * step);
            expected[j * BLOCKS / GRID * BLOCKS + i * BLOCKS / GRID] += p;
            sum += p;
        }
    assert_true(fabs(sum - 1) < 1e-3);
    for (uint32_t k = 0; k < RAYS; k++) {
        Sampler sampler = sampler_start(5, 0, 0, hash_u32(k));
        SunlitRay ray;
        float u[4];
        sampler_4d(&sampler, u);
        u[0] = unit_float(hash_u32(3 * k));
        u[1] = unit_float(hash_u32(3 * k + 1));
        u[2] = unit_float(hash_u32(3 * k + 2));
        assert_true(sunlit_map_choose(map, &from, u, &ray));
        int i = (int)(ray.s / map->side * BLOCKS), j = (int)(ray.t / map->side * BLOCKS);
        count[j * BLOCKS + i]++;
    }
    for (int b = 0; b < BLOCKS * BLOCKS; b++) {
        double e = expected[b] * RAYS;
        if (e < 1e-6) assert_int_equal(count[b], 0);
        if (e < 5) continue;
        chi2 += (count[b] - e) * (count[b] - e) / e;
        freedom++;
    }
    assert_true(freedom >= 1);
    assert_true(chi2 < freedom + 5 * sqrt(2.0 * freedom) + 5);
}

TEST(the_map_is_the_same_for_any_number_of_threads) {
    const Room one = {.hole = 0.03f, .walls = 0.2f, .floor = 0.8f, .threads = 1};
    Room four = one;
    four.threads = 4;
    SCOPED_WORLD a = room_world(&one), b = room_world(&four);
    Gauge head = {vec3(0.6f, 0.45f, 0.002f), vec3(0, 0, 1), 0, true};
    WorldMean first = world_measure(&a, head, 1, 1024);
    WorldMean second = world_measure(&b, head, 1, 1024);
    assert_memory_equal(&first, &second, sizeof first);
}

/* What may come in by an opening that is narrower than the map's pixels. */
TEST(where_no_sun_comes_in_an_unseen_beam_is_told) {
    const Room closed = {.hole = 0, .walls = 0.2f, .floor = 0.8f}, open = {.hole = 0.06f};
    SCOPED_WORLD dark = room_world(&closed), lit = room_world(&open);
    const SunlitMap *map = &dark.context.sunlit;
    double pixel = (double)map->side / SUNLIT_SIDE;
    assert_null(map->nodes);
    assert_close((double)map->unseen_lm, SUN_LX * pixel * pixel, 0.1);
    assert_close((double)sunlit_map_unseen(map), (double)map->unseen_lm * 0.8 / (PI * PI), 1e-5);
    assert_true(lit.context.sunlit.unseen_lm == 0);
}

/* Neither a display nor a camera: nobody whom light should reach. */
TEST(without_anybody_to_see_it_there_is_no_map) {
    const Room room = {.hole = 0.06f, .floor = 0.8f};
    SCOPED_WORLD world = world_start();
    build_room(world.scene, &room);
    world_ready(&world, 16);
    assert_null(world.context.sunlit.nodes);
}

TEST_PROGRAM(NULL, NULL)
