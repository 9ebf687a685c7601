/* SPDX-License-Identifier: Apache-2.0 */

#include "base/units.h"
#include "world_fixture.h"

static WorldMean luminance(const World *world, Vec3 from, Vec3 to, float spread, uint32_t seed,
                           int count) {
    Gauge gauge = {from, vec3_sub(to, from), spread, false};
    return world_measure(world, gauge, seed, count);
}

/* In the +z, +y plane, so high. */
static void set_sun(World *world, double elevation_degrees, double radius_degrees) {
    builder_sun(world->scene, PI, radians_from_degrees(elevation_degrees), 10000);
    world->scene->environment.sun_angular_radius = (float)radians_from_degrees(radius_degrees);
}

/* An upright mirror at the back of a floor: the head looks at it and sees the sun there. */
TEST(a_flat_mirror_gives_the_suns_illuminance_times_reflectance_and_cosine) {
    for (int degrees = 10; degrees <= 70; degrees += 20) {
        ENDS_BY(world_end) World world = world_start();
        builder_part(world.scene, builder_mirror(0.6f));
        builder_quad(world.scene, vec3(0, 2, -1), vec3(30, 0, 0), vec3(0, 30, 0));
        set_sun(&world, degrees, 0.26645);
        world_ready(&world, 16);
        double a = radians_from_degrees(degrees);
        double schlick = 0.6 + 0.4 * pow(1 - cos(a), 5);
        Gauge head = {vec3(0, 0, 0), vec3(0, 0, -1), 0, true};
        assert_close(world_measure(&world, head, 1, 2000).mean, 10000 * schlick * cos(a), 2e-3);
    }
}

/* Inside a ring, chrome within and matt without, on a matt table. */
static World ring_world(double sun_radius_degrees) {
    World world = world_start();
    enum { COLUMNS = 256 };
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 0, -2));
    builder_part(world.scene, builder_mirror(0.9f));
    uint32_t first = world.scene->vertex_count;
    for (int i = 0; i <= COLUMNS; i++)
        for (int k = 0; k < 2; k++) {
            double angle = 2 * PI * i / COLUMNS;
            Vec3 n = vec3((float)cos(angle), 0, (float)sin(angle));
            builder_vertex(world.scene, vec3_along(n, vec3(0, 1, 0), 0.3f * (float)k), vec3_neg(n),
                           0, 0);
        }
    for (uint32_t i = 0; i < COLUMNS; i++) {
        uint32_t at = first + 2 * i;
        builder_triangle(world.scene, at, at + 2, at + 1);
        builder_triangle(world.scene, at + 1, at + 2, at + 3);
    }
    set_sun(&world, 40, sun_radius_degrees);
    world_ready(&world, 16);
    return world;
}

/* Windows, lacquer, metal: what is sampled and what is left to chance add up to what chance
 * alone finds. The sun is made large, so that chance finds it. */
TEST(asking_mirrors_leaves_the_mean_as_it_is) {
    static const float roughness[] = {0, 1, 0, 0.02f, 0.1f, 0.07f, 0.21f};
    for (int i = 0; i < 7; i++) {
        ENDS_BY(world_end) World world = world_start();
        Material shiny = builder_material(0.3f), glossy = builder_material(0.5f);
        if (i == 0 || i == 4 || i == 6) shiny = builder_mirror(0.9f);
        shiny.clearcoat = i == 1;
        if (i == 2) {
            shiny.transmission = 1;
            shiny.lets_light_through = true;
        }
        if (i > 1) shiny.roughness = roughness[i];
        shiny.specular = i == 2 || i == 3 || i == 5;
        glossy.specular = 1;
        glossy.roughness = 0.5f;
        builder_part(world.scene, glossy);
        builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
        builder_part(world.scene, shiny);
        builder_sphere(world.scene, vec3(0, 0.6f, -0.5f), 0.5f, 24, 0);
        builder_quad(world.scene, vec3(0, 1, -1.5f), vec3(1, 0, 0), vec3(0, 1, 0.3f));
        set_sun(&world, 40, i < 4 ? 6 : 3);
        world_ready(&world, 16);
        assert_non_null(world.context.beams[BEAMS_OF_SUN].mirrors);
        Vec3 eye = vec3(0.3f, 1.5f, 2), to = vec3(-0.2f, 0, 0.2f);
        WorldMean asked = luminance(&world, eye, to, 0.4f, 1, 200000);
        world.context.beams[BEAMS_OF_SUN].mirrors = NULL;
        WorldMean chance = luminance(&world, eye, to, 0.4f, 2, i == 4 || i == 5 ? 1000000 : 400000);
        double sigma = sqrt(asked.sigma * asked.sigma + chance.sigma * chance.sigma);
        if (!(fabs(asked.mean - chance.mean) < 3 * sigma) || !(sigma < 0.01 * chance.mean))
            fail_msg("kind %d: %.6g +- %.2g asked, %.6g +- %.2g by chance", i, asked.mean,
                     asked.sigma, chance.mean, chance.sigma);
        if (!(asked.sigma < 0.8 * chance.sigma))
            fail_msg("kind %d: no less noise: %g, %g", i, asked.sigma, chance.sigma);
    }
}

/* 200 pixels of one view that differ by their seeds alone. */
TEST(no_pixel_is_a_firefly) {
    enum { SEEDS = 200 };
    ENDS_BY(world_end) World world = ring_world(0.26645);
    double pixel[SEEDS], mean = 0, variance = 0;
    for (int i = 0; i < SEEDS; i++) {
        pixel[i] =
            luminance(&world, vec3(0, 2, 1), vec3(0.1f, 0, -0.8f), 0.01f, (uint32_t)i, 64).mean;
        mean += pixel[i] / SEEDS;
    }
    for (int i = 0; i < SEEDS; i++) variance += (pixel[i] - mean) * (pixel[i] - mean) / (SEEDS - 1);
    for (int i = 0; i < SEEDS; i++)
        if (!(pixel[i] < mean + 5 * sqrt(variance)))
            fail_msg("seed %d: %g, mean %g, sigma %g", i, pixel[i], mean, sqrt(variance));
}

/* The variance gives the samples that an error takes. */
TEST(a_rings_caustic_takes_a_thirtieth_of_the_samples) {
    ENDS_BY(world_end) World world = ring_world(0.26645);
    Vec3 eye = vec3(0, 2, 1), to = vec3(0.1f, 0, -0.8f);
    WorldMean asked = luminance(&world, eye, to, 0.01f, 1, 20000);
    world.context.beams[BEAMS_OF_SUN].mirrors = NULL;
    WorldMean chance = luminance(&world, eye, to, 0.01f, 2, 2000000);
    double per_sample = pow(asked.sigma, 2) * 20000, by_chance = pow(chance.sigma, 2) * 2000000;
    print_message("[          ] variance a sample: %.3g asked, %.3g by chance, %.0f times; "
                  "%.6g and %.6g +- %.2g\n",
                  per_sample, by_chance, by_chance / per_sample, asked.mean, chance.mean,
                  chance.sigma);
    assert_true(per_sample * 30 < by_chance);
    assert_true(fabs(asked.mean - chance.mean) < 4 * chance.sigma);
}

/* Inside the ring the table lies in its light; outside and below nothing comes. */
TEST(mirrors_are_asked_where_their_light_falls) {
    ENDS_BY(world_end) World world = ring_world(0.26645);
    const MirrorBeams *beams = &world.context.beams[BEAMS_OF_SUN];
    float least = mirror_beams_prob(beams, 0, false, vec3(1.7f, 0, 1.7f));
    assert_true(least > 0 && least < 0.025f);
    for (int i = 0; i < 10; i++) {
        Vec3 inside = vec3(0, 0, -0.55f - 0.04f * (float)i);
        float prob = mirror_beams_prob(beams, 0, false, inside);
        if (!(prob > 3 * least && prob <= 1)) fail_msg("%g m: %g", (double)inside.z, (double)prob);
    }
    assert_true(mirror_beams_prob(beams, 0, true, vec3(0, 0, -0.7f)) <= least);
    float of_all = mirror_beams_prob(beams, NO_ID, false, vec3(0, 0, 0)); /* wherever it is */
    assert_true(beams->all_count > 0 && of_all > least && of_all <= 1);
}

TEST_PROGRAM(NULL, NULL)
