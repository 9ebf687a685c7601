/* SPDX-License-Identifier: Apache-2.0 */

#include "base/units.h"
#include "world_fixture.h"

enum { BOUNCES = 64 };

static WorldMean seen(const World *world, Vec3 from, Vec3 direction, float spread, int count) {
    return world_measure(world, (Gauge){from, direction, spread, false}, 1, count);
}

static double lux_at(const World *world, Vec3 from, Vec3 normal, int count) {
    return world_measure(world, (Gauge){from, normal, 0, true}, 2, count).mean;
}

static void assert_luminance(const char *what, WorldMean e, double expected) {
    if (!(fabs(e.mean - expected) <= 3.5 * e.sigma + 1e-4 * fabs(expected)))
        fail_msg("%s: %.6g +- %.2g cd/m2, expected %.6g", what, e.mean, e.sigma, expected);
    if (!(e.sigma <= 0.01 * fabs(expected)))
        fail_msg("%s: sigma %.2g of %.6g is too large to say anything", what, e.sigma, expected);
}

TEST(a_furnace_of_albedo_and_emission_one_half_shows_one) {
    ENDS_BY(world_end) World world = world_start();
    Material wall = builder_lamp(0.5f);
    for (int i = 0; i < 3; i++) wall.base_color[i] = 0.5f;
    builder_part(world.scene, wall);
    builder_sphere(world.scene, vec3(0, 0, 0), 1, 24, 1);
    world_ready(&world, BOUNCES);
    for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
        world.context.strategy = s;
        assert_luminance("furnace",
                         seen(&world, vec3(0.2f, 0.1f, 0), vec3(0, 0.3f, -1), 0.5f, 20000), 1);
    }
}

TEST(a_lambert_plane_under_the_sun_has_its_luminance) {
    ENDS_BY(world_end) World world = world_start();
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
    builder_sun(world.scene, 2, radians_from_degrees(35), 90000);
    world_ready(&world, BOUNCES);
    assert_luminance("sunlit plane", seen(&world, vec3(0, 2, 0), vec3(0.2f, -1, 0.1f), 0.1f, 20000),
                     90000 * sin(radians_from_degrees(35)) * 0.5 / PI);
}

/* A glossy floor, a lamp, a sky: every way to reach the light gives the same mean. */
TEST(light_samples_bsdf_samples_and_mis_agree) {
    const float roughness[] = {0.3f, 0.6f, 1.0f};
    for (int i = 0; i < 3; i++) {
        ENDS_BY(world_end) World world = world_start();
        Material floor = builder_material(0.4f);
        WorldMean e[3];
        floor.roughness = roughness[i];
        floor.specular = 1;
        floor.clearcoat = i == 1;
        floor.clearcoat_roughness = 0.5f;
        builder_part(world.scene, floor);
        builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
        builder_part(world.scene, builder_lamp(500));
        builder_quad(world.scene, vec3(0, 1.5f, -1), vec3(1, 0, 0), vec3(0, 0, 1));
        builder_sky(world.scene, 40);
        world_ready(&world, BOUNCES);
        for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
            int count = all_laws() ? 60000 : 20000;
            world.context.strategy = s;
            e[s] = seen(&world, vec3(0, 1, 2), vec3(0, -0.5f, -1), 0.2f, count);
        }
        for (int s = 1; s < 3; s++)
            if (fabs(e[s].mean - e[0].mean) >
                3.5 * sqrt(e[s].sigma * e[s].sigma + e[0].sigma * e[0].sigma))
                fail_msg("roughness %g: strategy %d gives %g +- %g, MIS %g +- %g",
                         (double)roughness[i], s, e[s].mean, e[s].sigma, e[0].mean, e[0].sigma);
    }
}

/* The slab's transmittance, seen directly and by the light it lets fall on a wall. */
TEST(a_window_passes_what_a_slab_passes) {
    const double degrees[] = {0, 30, 45, 60, 75},
                 slab[] = {0.918318, 0.915957, 0.902528, 0.843471, 0.614805};
    for (int i = 0; i < 5; i++) {
        ENDS_BY(world_end) World world = world_start();
        float a = (float)radians_from_degrees(degrees[i]);
        builder_part(world.scene, builder_lamp(1000));
        builder_quad(world.scene, vec3(0, 0, -10), vec3(1, 0, 0), vec3(0, 1, 0));
        builder_part(world.scene, builder_pane(1.52f));
        builder_quad(world.scene, vec3(0, 0, -5),
                     vec3(4 * (float)cos((double)a), 0, 4 * (float)sin((double)a)), vec3(0, 4, 0));
        world_ready(&world, BOUNCES);
        assert_luminance("window", seen(&world, vec3(0, 0, 0), vec3(0, 0, -1), 0.001f, 40000),
                         1000 * slab[i]);
    }
}

TEST(the_sun_lights_a_wall_through_a_window) {
    ENDS_BY(world_end) World world = world_start();
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
    builder_part(world.scene, builder_pane(1.52f));
    builder_quad(world.scene, vec3(0, 4, 0), vec3(50, 0, 0), vec3(0, 0, -50));
    builder_sun(world.scene, 0, radians_from_degrees(45), 10000);
    world_ready(&world, BOUNCES);
    world.context.max_bounces = 1;
    assert_luminance("wall behind glass",
                     seen(&world, vec3(0, 2, 0), vec3(0.1f, -1, 0), 0.1f, 20000),
                     10000 * sin(PI / 4) * 0.902528 * 0.5 / PI);
}

TEST(a_mirror_of_metal_shows_its_reflectance_times_what_is_there) {
    for (int degrees = 0; degrees <= 80; degrees += 20) {
        ENDS_BY(world_end) World world = world_start();
        double a = radians_from_degrees(degrees);
        builder_part(world.scene, builder_mirror(0.8f));
        builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
        builder_sky(world.scene, 100);
        world_ready(&world, BOUNCES);
        Vec3 from = vec3(0, (float)cos(a), (float)sin(a));
        double schlick = 0.8 + 0.2 * pow(1 - cos(a), 5);
        assert_luminance("mirror", seen(&world, from, vec3_neg(from), 0.001f, 4000), 100 * schlick);
    }
}

TEST(a_clear_ball_in_a_uniform_sky_is_invisible) {
    ENDS_BY(world_end) World world = world_start();
    Material glass = builder_pane(1.5f);
    glass.is_solid = true;
    glass.lets_light_through = false;
    builder_part(world.scene, glass);
    builder_sphere(world.scene, vec3(0, 0, 0), 1, 48, 0);
    builder_sky(world.scene, 100);
    world_ready(&world, BOUNCES);
    assert_luminance("ball", seen(&world, vec3(0, 0, 3), vec3(0, 0, -1), 0.6f, 20000), 100);
}

/* A pane met at 70 degrees, and a film that shines as the sky does. */
TEST(sheets_in_a_uniform_sky_are_invisible) {
    ENDS_BY(world_end) World world = world_start();
    Material film = builder_lamp(100);
    double a = radians_from_degrees(70);
    film.alpha_mode = ALPHA_BLEND;
    film.base_color[3] = 0.4f;
    film.lets_light_through = film.double_sided = true;
    builder_part(world.scene, builder_pane(1.5f));
    builder_quad(world.scene, vec3(0, 0, -1), vec3(0.5f, 0, 0),
                 vec3(0, (float)(0.5 * cos(a)), (float)(-0.5 * sin(a))));
    builder_part(world.scene, film);
    builder_quad(world.scene, vec3(0, 0, 1), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0));
    builder_sky(world.scene, 100);
    world_ready(&world, BOUNCES);
    for (int way = -1; way <= 1; way += 2) {
        Vec3 ahead = vec3(0, 0, (float)way);
        assert_luminance("sheet", seen(&world, vec3(0, 0, 0), ahead, 0.1f, 20000), 100);
    }
}

TEST(half_there_shows_half_of_what_is_behind) {
    ENDS_BY(world_end) World world = world_start();
    Material veil = builder_lamp(0);
    builder_part(world.scene, builder_lamp(100));
    builder_quad(world.scene, vec3(0, 0, -2), vec3(1, 0, 0), vec3(0, 1, 0));
    veil.alpha_mode = ALPHA_BLEND;
    veil.base_color[3] = 0.25f;
    veil.lets_light_through = true;
    builder_part(world.scene, veil);
    builder_quad(world.scene, vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, 1, 0));
    world_ready(&world, BOUNCES);
    assert_luminance("veil", seen(&world, vec3(0, 0, 0), vec3(0, 0, -1), 0.01f, 40000), 75);
}

TEST(bounces_are_counted_as_documented) {
    ENDS_BY(world_end) World world = world_start();
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(1000, 0, 0), vec3(0, 0, -1000));
    builder_sky(world.scene, 100);
    world_ready(&world, BOUNCES);
    world.context.max_bounces = 0;
    assert_near(seen(&world, vec3(0, 1, 0), vec3(0, -1, 0), 0.1f, 100).mean, 0, 0);
    world.context.max_bounces = 1;
    assert_luminance("one bounce", seen(&world, vec3(0, 1, 0), vec3(0, -1, 0), 0.1f, 20000), 50);
}

TEST(the_back_of_a_one_sided_emitter_is_dark) {
    ENDS_BY(world_end) World world = world_start();
    builder_part(world.scene, builder_lamp(100));
    builder_quad(world.scene, vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, -1, 0));
    world_ready(&world, BOUNCES);
    assert_near(seen(&world, vec3(0, 0, 0), vec3(0, 0, -1), 0.01f, 100).mean, 0, 0);
    world.scene->materials[0].double_sided = true;
    assert_luminance("both sides", seen(&world, vec3(0, 0, 0), vec3(0, 0, -1), 0.01f, 4000), 100);
}

TEST(a_luxmeter_reads_what_falls_on_it) {
    ENDS_BY(world_end) World world = world_start();
    builder_part(world.scene, builder_material(0));
    builder_quad(world.scene, vec3(0, -1, 0), vec3(9000, 0, 0), vec3(0, 0, -9000));
    builder_sky(world.scene, 100);
    builder_sun(world.scene, 0, radians_from_degrees(30), 1000);
    world.scene->lights[world.scene->light_count++] =
        (PunctualLight){.kind = LIGHT_POINT, .position = {0, 3, 0}, .intensity = {900, 900, 900}};
    world_ready(&world, BOUNCES);
    assert_close(lux_at(&world, vec3(0, 0, 0), vec3(0, 1, 0), 20000),
                 PI * 100 + 1000 * 0.5 + 900 / 9.0, 2e-3);
    assert_near(lux_at(&world, vec3(0, -0.5f, 0), vec3(0, -1, 0), 4000), 0, 1e-3);
}

/* The ray meets the diagonal that both triangles of the pane share: one pane, tinted once. */
TEST(a_pane_is_passed_once_on_the_edge_of_its_triangles) {
    ENDS_BY(world_end) World world = world_start();
    builder_part(world.scene, builder_material(0));
    builder_quad(world.scene, vec3(0, -1, 0), vec3(5, 0, 0), vec3(0, 0, -5));
    builder_part(world.scene, builder_pane(1.52f));
    builder_quad(world.scene, vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, -1));
    world.scene->lights[world.scene->light_count++] =
        (PunctualLight){.kind = LIGHT_POINT, .position = {0, 2, 0}, .intensity = {400, 400, 400}};
    world_ready(&world, BOUNCES);
    assert_close(lux_at(&world, vec3(0, 0, 0), vec3(0, 1, 0), 4000), 100 * 0.918318, 2e-3);
}

TEST_PROGRAM(NULL, NULL)
