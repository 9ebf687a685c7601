/* SPDX-License-Identifier: Apache-2.0 */
#include "check.h"

#include "base/units.h"
#include "path/path.h"
#include "world_fixture.h"

typedef struct Estimate {
    double mean, sigma, largest;
} Estimate;

/* Illuminance, lx, of a luxmeter's head. */
static Estimate illuminance(const World *world, LitPoint point, uint32_t seed, int count)
{
    double sum = 0, squares = 0, largest = 0;
    PathStatistics statistics = {0};
    for (int i = 0; i < count; i++) {
        Sampler sampler = sampler_start(seed, 0, 0, (uint32_t)i);
        Wavelengths w;
        float lx[3];
        wavelengths_sample(sampler_1d(&sampler), &w);
        PathStart start = {.context = &world->context, .wavelengths = &w, .sampler = &sampler,
                           .statistics = &statistics};
        path_from_point(&start, point, lx);
        sum += (double)lx[1];
        squares += (double)lx[1] * (double)lx[1];
        largest = fmax(largest, (double)lx[1]);
    }
    double mean = sum / count;
    return (Estimate){mean, sqrt(fmax(squares / count - mean * mean, 0) / count), largest};
}

/* Luminance, cd m^-2, along rays through a square of side `spread` at distance 1. */
static Estimate luminance(const World *world, Vec3 from, Vec3 to, float spread, uint32_t seed,
                          int count)
{
    double sum = 0, squares = 0, largest = 0;
    Frame frame = frame_from_z(vec3_normalize(vec3_sub(to, from)));
    PathStatistics statistics = {0};
    for (int i = 0; i < count; i++) {
        Sampler sampler = sampler_start(seed, 0, 0, (uint32_t)i);
        Vec2 at = sampler_2d(&sampler);
        Wavelengths w;
        PathResult result;
        wavelengths_sample(sampler_1d(&sampler), &w);
        Vec3 local = vec3(spread * (at.x - 0.5f), spread * (at.y - 0.5f), 1);
        Ray ray = {from, vec3_normalize(frame_to_world(&frame, local)), 0, INFINITY};
        PathStart start = {.context = &world->context, .wavelengths = &w, .sampler = &sampler,
                           .statistics = &statistics};
        path_from_ray(&start, ray, &result);
        sum += (double)result.xyz[1];
        squares += (double)result.xyz[1] * (double)result.xyz[1];
        largest = fmax(largest, (double)result.xyz[1]);
    }
    double mean = sum / count;
    return (Estimate){mean, sqrt(fmax(squares / count - mean * mean, 0) / count), largest};
}

static Material chrome(float reflectance)
{
    Material material = builder_material(reflectance);
    material.metallic = 1;
    material.roughness = 0;
    return material;
}

/* In the +z, +y plane, so high. */
static void set_sun(World *world, double elevation_degrees, double radius_degrees)
{
    Environment *environment = &world->scene->environment;
    environment->has_sun = true;
    environment->sun_azimuth = (float)PI;
    environment->sun_elevation = (float)radians_from_degrees(elevation_degrees);
    environment->sun_illuminance_lx = 10000;
    environment->sun_angular_radius = (float)radians_from_degrees(radius_degrees);
}

/* An upright mirror at the back of a floor: the head looks at it and sees the sun there. */
TEST(a_flat_mirror_gives_the_suns_illuminance_times_reflectance_and_cosine)
{
    for (int degrees = 10; degrees <= 70; degrees += 20) {
        World world = world_start();
        builder_part(world.scene, chrome(0.6f));
        builder_quad(world.scene, vec3(0, 2, -1), vec3(30, 0, 0), vec3(0, 30, 0));
        set_sun(&world, degrees, 0.26645);
        world_ready(&world, 16);
        double a = radians_from_degrees(degrees);
        double schlick = 0.6 + 0.4 * pow(1 - cos(a), 5);
        LitPoint head = {vec3(0, 0, 0), vec3(0, 0, -1), false};
        assert_close(illuminance(&world, head, 1, 2000).mean, 10000 * schlick * cos(a), 2e-3);
        world_end(&world);
    }
}

/* Inside a ring, chrome within and matt without, on a matt table. */
static World ring_world(double sun_radius_degrees)
{
    World world = world_start();
    enum { COLUMNS = 256 };
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 0, -2));
    builder_part(world.scene, chrome(0.9f));
    uint32_t first = world.scene->vertex_count;
    for (int i = 0; i <= COLUMNS; i++)
        for (int k = 0; k < 2; k++) {
            double angle = 2 * PI * i / COLUMNS;
            Vec3   n = vec3((float)cos(angle), 0, (float)sin(angle));
            builder_vertex(world.scene, vec3_along(n, vec3(0, 1, 0), 0.3f * (float)k),
                           vec3_neg(n), 0, 0);
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

/* Windows, lacquer, metal: what is asked for and what is left to chance add up to what chance
 * alone finds. The sun is made large, so that chance finds it. */
TEST(asking_mirrors_leaves_the_mean_as_it_is)
{
    for (int i = 0; i < 6; i++) {
        World world = world_start();
        Material shiny = builder_material(0.3f), glossy = builder_material(0.5f);
        if (i == 0) shiny = chrome(0.9f);
        shiny.clearcoat = i == 1;
        if (i == 2) {
            shiny.transmission = 1;
            shiny.roughness = 0;
            shiny.specular = 1;
            shiny.lets_light_through = true;
        }
        if (i == 3) {
            shiny.roughness = 0.02f;
            shiny.specular = 1;
        }
        if (i == 4) {
            shiny = chrome(0.9f);
            shiny.roughness = 0.1f;
        }
        if (i == 5) {
            shiny.roughness = 0.07f;
            shiny.specular = 1;
        }
        glossy.specular = 1;
        glossy.roughness = 0.5f;
        builder_part(world.scene, glossy);
        builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
        builder_part(world.scene, shiny);
        builder_sphere(world.scene, vec3(0, 0.6f, -0.5f), 0.5f, 24, 0);
        builder_quad(world.scene, vec3(0, 1, -1.5f), vec3(1, 0, 0), vec3(0, 1, 0.3f));
        set_sun(&world, 40, i < 4 ? 6 : 3);
        world_ready(&world, 16);
        assert_non_null(world.context.beams.mirrors);
        Vec3     eye = vec3(0.3f, 1.5f, 2), to = vec3(-0.2f, 0, 0.2f);
        Estimate asked = luminance(&world, eye, to, 0.4f, 1, 200000);
        world.context.beams.mirrors = NULL;
        Estimate chance = luminance(&world, eye, to, 0.4f, 2, i < 4 ? 400000 : 1000000);
        double   sigma = sqrt(asked.sigma * asked.sigma + chance.sigma * chance.sigma);
        if (!(fabs(asked.mean - chance.mean) < 3 * sigma) || !(sigma < 0.01 * chance.mean))
            fail_msg("kind %d: %.6g +- %.2g asked, %.6g +- %.2g by chance", i, asked.mean,
                     asked.sigma, chance.mean, chance.sigma);
        if (!(asked.sigma < 0.8 * chance.sigma))
            fail_msg("kind %d: no less noise: %g, %g", i, asked.sigma, chance.sigma);
        world_end(&world);
    }
}

/* 200 pixels of one view that differ by their seeds alone. */
TEST(no_pixel_is_a_firefly)
{
    enum { SEEDS = 200 };
    World  world = ring_world(0.26645);
    double pixel[SEEDS], mean = 0, variance = 0;
    for (int i = 0; i < SEEDS; i++) {
        pixel[i] = luminance(&world, vec3(0, 2, 1), vec3(0.1f, 0, -0.8f), 0.01f, (uint32_t)i,
                             64).mean;
        mean += pixel[i] / SEEDS;
    }
    for (int i = 0; i < SEEDS; i++)
        variance += (pixel[i] - mean) * (pixel[i] - mean) / (SEEDS - 1);
    for (int i = 0; i < SEEDS; i++)
        if (!(pixel[i] < mean + 5 * sqrt(variance)))
            fail_msg("seed %d: %g, mean %g, sigma %g", i, pixel[i], mean, sqrt(variance));
    world_end(&world);
}

/* The variance tells the samples that an error takes. */
TEST(a_rings_caustic_takes_a_thirtieth_of_the_samples)
{
    World    world = ring_world(0.26645);
    Vec3     eye = vec3(0, 2, 1), to = vec3(0.1f, 0, -0.8f);
    Estimate asked = luminance(&world, eye, to, 0.01f, 1, 20000);
    world.context.beams.mirrors = NULL;
    Estimate chance = luminance(&world, eye, to, 0.01f, 2, 2000000);
    double per_sample = pow(asked.sigma, 2) * 20000, by_chance = pow(chance.sigma, 2) * 2000000;
    print_message("[          ] variance a sample: %.3g asked, %.3g by chance, %.0f times; "
                  "%.6g and %.6g +- %.2g\n", per_sample, by_chance, by_chance / per_sample,
                  asked.mean, chance.mean, chance.sigma);
    assert_true(per_sample * 30 < by_chance);
    assert_true(fabs(asked.mean - chance.mean) < 4 * chance.sigma);
    world_end(&world);
}

/* Inside the ring the table lies in its light; outside and below nothing comes. */
TEST(mirrors_are_asked_where_their_light_falls)
{
    World world = ring_world(0.26645);
    const MirrorBeams *beams = &world.context.beams;
    float least = mirror_beams_prob(beams, 0, false, vec3(1.7f, 0, 1.7f));
    assert_true(least > 0 && least < 0.025f);
    for (int i = 0; i < 10; i++) {
        Vec3  inside = vec3(0, 0, -0.55f - 0.04f * (float)i);
        float prob = mirror_beams_prob(beams, 0, false, inside);
        if (!(prob > 3 * least && prob <= 1))
            fail_msg("%g m: %g", (double)inside.z, (double)prob);
    }
    assert_true(mirror_beams_prob(beams, 0, true, vec3(0, 0, -0.7f)) <= least);
    assert_true(mirror_beams_prob(beams, NO_ID, false, vec3(0, 0, 0)) == 1);
    world_end(&world);
}

TEST_PROGRAM(NULL, NULL)
