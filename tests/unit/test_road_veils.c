/* SPDX-License-Identifier: Apache-2.0 */
/* The veil over a road, by age and by display, against its formula. */
#include "fixture.h"

#include "base/count.h"
#include "base/units.h"
#include "review/eye/eye_reading.h"
#include "vision/eye_spread.h"
#include "vision/road_glare.h"
#include "world_fixture.h"

#define ROUNDS 2

static const ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};
static const double AGES[] = {25, 70};

static RoadReading read_road(World *world) {
    static const RoadAges ages = {AGES, COUNT_OF(AGES), 0.5};
    const Kernel *kernel;
    assert_done(kernel_choose(NULL, &kernel, &err));
    if (!world->bvh) world_ready(world, 16);
    Setup setup = {.request = &request,
                   .tools = {.kernel = kernel, .threads = 2},
                   .scene = world->scene,
                   .context = world->context};
    RoadReading found =
        road_reading_start(COUNT_OF(AGES), world->scene->display_count, &world->arena);
    EyeLook look = {vec3(0, 0, 0), vec3(0, 0, -1),
                    ROUNDS,        NULL,
                    false,         road_veils_start(world->scene, &ages, &world->arena)};
    eye_read(&setup, &look, world->arena);
    road_veils_read(look.road, &found);
    return found;
}

/* A black world, but for what a test adds. */
static World dark_world(void) {
    World world = world_start();
    builder_part(world.scene, builder_material(0));
    builder_quad(world.scene, vec3(0, -100, 0), vec3(1, 0, 0), vec3(0, 0, -1));
    return world;
}

/* Above the line of sight. */
static Vec3 at_angle(double degrees) {
    double t = radians_from_degrees(degrees);
    return vec3(0, (float)sin(t), (float)-cos(t));
}

/* A square that faces the eye, so far off and so far away. */
static void add_square(World *world, double degrees, double distance, double half) {
    double t = radians_from_degrees(degrees);
    builder_quad(world->scene, vec3_scale(at_angle(degrees), (float)distance),
                 vec3((float)half, 0, 0), vec3(0, (float)(half * cos(t)), (float)(half * sin(t))));
}

static void assert_within(double required, RoadFound found) {
    if (!(found.low <= required && required <= found.high))
        fail_msg("required %.6g, found %.6g (%.6g to %.6g)", required, found.mean, found.low,
                 found.high);
}

TEST(a_screen_beside_the_road_makes_the_published_increment) {
    static const double required[] = {11.3, 24.7}; /* of 25 and 70 years, within 0.5 % */
    SCOPED_WORLD world = dark_world();
    double half = 0.001, area = 0.30 * 0.17 / (0.75 * 0.75); /* sr, as one small source */
    builder_part(world.scene, builder_lamp((float)(50 * area / (4 * half * half))));
    add_square(&world, 25, 1, half);
    RoadReading found = read_road(&world);
    for (int a = 0; a < COUNT_OF(AGES); a++) {
        RoadFound all = road_found_whole(&found, a);
        assert_close(road_threshold_increment(all.mean, 0.3), required[a], 0.005);
        double lux = all.mean / road_veil_at(25, AGES[a]);
        assert_close(lux, 50 * area * cos(radians_from_degrees(25)), 0.002);
        assert_close(all.by_spread, lux * eye_spread_at(25, (HumanEye){AGES[a], 0.5}), 0.002);
    }
}

/* Sources at angles of both branches, each by itself. */
TEST(a_small_lamp_veils_by_road_lightings_formula) {
    static const double angles[] = {0.5, 1.2, 3, 10, 60, 80};
    for (int i = 0; i < COUNT_OF(angles); i++) {
        SCOPED_WORLD world = dark_world();
        double half = 0.0005, lux = 1e5 * 4 * half * half * cos(radians_from_degrees(angles[i]));
        builder_part(world.scene, builder_lamp(1e5f));
        add_square(&world, angles[i], 1, half);
        RoadReading found = read_road(&world);
        for (int a = 0; a < COUNT_OF(AGES); a++)
            assert_close(road_found_whole(&found, a).mean, lux * road_veil_at(angles[i], AGES[a]),
                         0.01);
    }
}

/* What is looked at is no veil; what it would be by the formula is much. */
TEST(a_lit_road_in_the_line_of_sight_is_no_veil) {
    SCOPED_WORLD world = dark_world();
    builder_sky(world.scene, 3);
    RoadReading found = read_road(&world);
    double sum = 0; /* of an even sky beyond 1 degree, by rings */
    for (double t = 1; t < 89.9; t += 0.001) {
        double rad = radians_from_degrees(t + 0.0005);
        sum += 3 * road_veil_at(t + 0.0005, 25) * 2 * PI * sin(rad) * cos(rad) *
               radians_from_degrees(0.001);
    }
    assert_close(road_found_whole(&found, 0).mean, sum, 0.03);
}

TEST(a_display_veils_by_its_level_and_is_told_from_the_rest) {
    RoadFound own[2];
    for (int bright = 0; bright < 2; bright++) {
        SCOPED_WORLD world = dark_world();
        Display *display = world_display(&world);
        display->level = bright ? 0.5f : 0.25f;
        add_square(&world, 30, 0.8, 0.08);
        builder_part(world.scene, builder_lamp(2e4f));
        add_square(&world, 12, 1, 0.002);
        RoadReading found = read_road(&world);
        own[bright] = road_found(&found, 0, 0);
        RoadFound all = road_found_whole(&found, 0);
        double lamp =
            2e4 * 4 * 0.002 * 0.002 * cos(radians_from_degrees(12)) * road_veil_at(12, 25);
        assert_close(all.mean - own[bright].mean, lamp, 0.02);
        double ways = 0;
        for (int w = 0; w < ROAD_WAYS; w++) ways += found.shares[0].way[w];
        assert_close(ways, own[bright].mean, 1e-9);
        assert_close(found.shares[0].way[ROAD_STRAIGHT], ways, 1e-9); /* all else is black */
    }
    assert_true(own[0].mean > 0);
    assert_within(own[1].mean / 2,
                  (RoadFound){own[0].mean, 0.97 * own[0].mean, 1.03 * own[0].mean, NAN});
}

/* A mirror shows the display, which turns its back to the eye. */
TEST(a_display_is_told_by_the_glass_that_shows_it) {
    SCOPED_WORLD world = dark_world();
    Display *display = world_display(&world);
    display->level = 1;
    /* at the side of the eye, facing ahead */
    builder_quad(world.scene, vec3(0.6f, 0, 0.01f), vec3(0, 0.2f, 0), vec3(0.2f, 0, 0));
    builder_part(world.scene, builder_mirror(0.5f));
    int mirror = world.scene->part_count - 1;
    builder_quad(world.scene, vec3(0.5f, 0, -1), vec3(0.4f, 0, 0), vec3(0, 0.4f, 0));
    RoadReading found = read_road(&world);
    const RoadShares *shares = &found.shares[0];
    assert_true(shares->way[ROAD_MIRRORED] > 0);
    assert_int_equal((int)shares->mirror, mirror);
    assert_close(shares->mirrored, shares->way[ROAD_MIRRORED], 1e-9);
    assert_close(shares->way[ROAD_MIRRORED], road_found(&found, 0, 0).mean, 0.02);
    assert_close(road_found_whole(&found, 0).mean, road_found(&found, 0, 0).mean, 1e-6);
}

TEST_PROGRAM(NULL, NULL)
