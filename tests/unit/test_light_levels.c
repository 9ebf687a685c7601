/* SPDX-License-Identifier: Apache-2.0 */
/* Emitters that were sorted for other levels of the displays. */

#include "reading_fixture.h"

static const Vec3 eye = {0.1f, 0.1f, 0.7f};
static const Vec3 targets[4] = {
    {-0.1f, -0.05f, 0}, {0.1f, 0.05f, 0}, {-0.1f, 0.05f, 0}, {0.1f, -0.05f, 0}};
static const LitPoint head = {{0, -0.2f, 0.5f}, {0, 1, 0}, false};

/* A display that looks along +z, another to the side that shines on it, grey walls, a lamp. */
static World room(void) {
    World world = world_start();
    Scene *scene = world.scene;
    builder_part(scene, builder_material(0.5f));
    builder_quad(scene, vec3(0, -0.3f, 0.5f), vec3(0.6f, 0, 0), vec3(0, 0, -0.6f));
    builder_part(scene, builder_material(0.5f));
    builder_quad(scene, vec3(0, 0, 1.1f), vec3(-0.6f, 0, 0), vec3(0, 0.3f, 0));
    builder_part(scene, builder_lamp(400));
    builder_quad(scene, vec3(0.2f, 0.4f, 0.5f), vec3(0.1f, 0, 0), vec3(0, 0, 0.1f));
    world_display(&world);
    builder_quad(scene, vec3(0, 0, 0), vec3(0.2f, 0, 0), vec3(0, 0.1f, 0));
    world_display(&world);
    builder_quad(scene, vec3(-0.4f, 0, 0.4f), vec3(0.1f, 0, -0.1f), vec3(0, 0.1f, 0));
    world_ready(&world, 8);
    return world;
}

/* Whose lights are made anew for these levels. */
static void set_levels(World *world, const double level[2]) {
    for (int i = 0; i < 2; i++) world->scene->displays[i].level = (float)level[i];
    world->context = path_context_relight(
        &world->context, lights_with_levels(world->context.lights, &world->arena), &world->arena);
}

static ProbeAim aim_of(const World *world, uint32_t seed, bool by_meter) {
    ProbeAim aim = {.context = &world->context, .seed = seed};
    if (by_meter) {
        aim.meter = &head;
        return aim;
    }
    aim.eye = eye;
    aim.targets = targets;
    aim.target_count = 4;
    return aim;
}

/* Under these levels, of lights that stood under `then`. */
static const Lights *changed(World *world, const double then[2], const double now[2]) {
    set_levels(world, then);
    for (int i = 0; i < 2; i++) world->scene->displays[i].level = (float)now[i];
    return lights_with_levels(world->context.lights, &world->arena);
}

TEST(emitters_are_sorted_again_where_a_display_changes_four_times) {
    static const struct {
        double then[2], now[2];
        bool is_again;
    } CASES[] = {{{1, 1}, {1, 1}, false},  {{1, 1}, {0.25, 4}, false}, {{1, 1}, {0.24, 1}, true},
                 {{1, 1}, {1, 4.1}, true}, {{1, 1}, {0, 1}, true},     {{0, 1}, {0, 1}, false},
                 {{0, 1}, {1e-6, 1}, true}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        ENDS_BY(world_end) World world = room();
        const Lights *lights = changed(&world, CASES[i].then, CASES[i].now);
        assert_int_equal(lights != world.context.lights, CASES[i].is_again);
    }
}

/* Which emitters are chosen how often is no part of the light: both say the same of it. */
TEST(emitters_of_other_levels_tell_the_same_light) {
    static const double ONE[2] = {1, 1}, LEVELS[2] = {0.25, 4}, FAR[2] = {8, 0.05};
    ReadingGoal longer = {.most = all_laws() ? 1 << 17 : 1 << 16};
    ENDS_BY(world_end) World world = room();
    ProbeTools tools = reading_tools(2);
    for (int by_meter = 0; by_meter < 2; by_meter++) {
        Reading kept, own;
        ProbeAim aim = aim_of(&world, 5, by_meter);
        set_levels(&world, FAR);
        set_levels(&world, ONE);
        set_levels(&world, LEVELS); /* those of one stay */
        kept = reading_take(&aim, &longer, &tools, world.arena);
        set_levels(&world, FAR);
        set_levels(&world, LEVELS); /* made for them */
        own = reading_take(&aim, &longer, &tools, world.arena);
        assert_true(kept.reflected != own.reflected);
        assert_true(kept.interval.low < own.interval.high);
        assert_true(own.interval.low < kept.interval.high);
        assert_close(kept.reflected / own.reflected, 1, 0.01);
    }
}

/* A display that dims shows paths the sun that was there before, in mirrors as well. */
TEST(other_levels_leave_what_the_suns_rays_do) {
    ReadingGoal goal = {.most = 4096};
    ENDS_BY(world_end) World world = room();
    ProbeTools tools = reading_tools(2);
    Lights *sunny;
    builder_part(world.scene, builder_mirror(0.6f));
    builder_quad(world.scene, vec3(-0.3f, 0, 0.3f), vec3(0.1f, 0, 0.1f), vec3(0, 0.1f, 0));
    world_ready(&world, 8);
    builder_sky(world.scene, 500);
    builder_sun(world.scene, 0.4, 0.9, 20000);
    assert_done(lights_build(world.scene, &world.arena, &sunny, &err));
    PathContext before = path_context_relight(&world.context, sunny, &world.arena);
    assert_non_null(before.sunlit.nodes);
    assert_non_null(before.beams[BEAMS_OF_SUN].mirrors);
    world.scene->displays[0].level = 0.1f;
    const Lights *dimmed = lights_with_levels(sunny, &world.arena);
    PathContext relit = path_context_relight(&before, dimmed, &world.arena);
    PathContext kept = path_context_relevel(&before, dimmed, &world.arena);
    assert_ptr_equal(kept.beams[BEAMS_OF_SUN].mirrors, before.beams[BEAMS_OF_SUN].mirrors);
    for (int by_meter = 0; by_meter < 2; by_meter++) {
        ProbeAim aim = aim_of(&world, 5, by_meter);
        aim.context = &relit;
        double anew = reading_take(&aim, &goal, &tools, world.arena).reflected;
        aim.context = &kept;
        assert_true(anew > 0);
        assert_true(reading_take(&aim, &goal, &tools, world.arena).reflected == anew);
    }
}

TEST_PROGRAM(NULL, NULL)
