/* SPDX-License-Identifier: Apache-2.0 */
#include "check.h"

#include "base/units.h"
#include "path/path.h"
#include "world_fixture.h"

enum { BOUNCES = 64 };

typedef struct Estimate {
    double mean, sigma;
} Estimate;

/* Luminance, cd m^-2, along rays from `from` into a cone of about `spread` around direction. */
static Estimate luminance(const World *world, Vec3 from, Vec3 direction, float spread,
                          int count)
{
    double sum = 0, squares = 0;
    Frame frame = frame_from_z(vec3_normalize(direction));
    PathStatistics statistics = {0};
    for (int i = 0; i < count; i++) {
        Sampler sampler = sampler_start(1, 0, 0, (uint32_t)i);
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
    }
    double mean = sum / count;
    return (Estimate){mean, sqrt(fmax(squares / count - mean * mean, 0) / count)};
}

static void assert_luminance(const char *what, Estimate e, double expected)
{
    if (!(fabs(e.mean - expected) <= 3.5 * e.sigma + 1e-4 * fabs(expected)))
        fail_msg("%s: %.6g +- %.2g cd/m2, expected %.6g", what, e.mean, e.sigma, expected);
    if (!(e.sigma <= 0.01 * fabs(expected)))
        fail_msg("%s: sigma %.2g of %.6g is too large to say anything", what, e.sigma,
                 expected);
}

static Material emitter(float cd_m2)
{
    Material material = builder_material(0);
    material.is_emitter = true;
    for (int i = 0; i < 3; i++) material.emissive_cd_m2[i] = cd_m2;
    return material;
}

static void set_sky(World *world, float cd_m2)
{
    world->scene->environment.kind = ENVIRONMENT_CONSTANT;
    world->scene->environment.luminance_cd_m2 = cd_m2;
    for (int i = 0; i < 3; i++) world->scene->environment.color[i] = 1;
}

TEST(a_furnace_of_albedo_and_emission_one_half_shows_one)
{
    World world = world_start();
    Material wall = emitter(0.5f);
    for (int i = 0; i < 3; i++) wall.base_color[i] = 0.5f;
    builder_part(world.scene, wall);
    builder_sphere(world.scene, vec3(0, 0, 0), 1, 24, 1);
    world_ready(&world, BOUNCES);
    for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
        world.context.strategy = s;
        assert_luminance("furnace",
                         luminance(&world, vec3(0.2f, 0.1f, 0), vec3(0, 0.3f, -1), 0.5f, 20000),
                         1);
    }
    world_end(&world);
}

TEST(a_lambert_plane_under_the_sun_has_its_luminance)
{
    World world = world_start();
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(35);
    world.scene->environment.sun_azimuth = 2;
    world.scene->environment.sun_illuminance_lx = 90000;
    world_ready(&world, BOUNCES);
    assert_luminance("sunlit plane",
                     luminance(&world, vec3(0, 2, 0), vec3(0.2f, -1, 0.1f), 0.1f, 20000),
                     90000 * sin(radians_from_degrees(35)) * 0.5 / PI);
    world_end(&world);
}

/* A glossy floor, a lamp, a sky: every way to reach the light gives the same mean. */
TEST(light_samples_bsdf_samples_and_mis_agree)
{
    const float roughness[] = {0.3f, 0.6f, 1.0f};
    for (int i = 0; i < 3; i++) {
        World world = world_start();
        Material floor = builder_material(0.4f);
        Estimate e[3];
        floor.roughness = roughness[i];
        floor.specular = 1;
        floor.clearcoat = i == 1;
        floor.clearcoat_roughness = 0.5f;
        builder_part(world.scene, floor);
        builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
        builder_part(world.scene, emitter(500));
        builder_quad(world.scene, vec3(0, 1.5f, -1), vec3(1, 0, 0), vec3(0, 0, 1));
        set_sky(&world, 40);
        world_ready(&world, BOUNCES);
        for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
            world.context.strategy = s;
            e[s] = luminance(&world, vec3(0, 1, 2), vec3(0, -0.5f, -1), 0.2f, 60000);
        }
        for (int s = 1; s < 3; s++)
            if (fabs(e[s].mean - e[0].mean) >
                3.5 * sqrt(e[s].sigma * e[s].sigma + e[0].sigma * e[0].sigma))
                fail_msg("roughness %g: strategy %d gives %g +- %g, MIS %g +- %g",
                         (double)roughness[i], s, e[s].mean, e[s].sigma, e[0].mean, e[0].sigma);
        world_end(&world);
    }
}

static Material window_material(float ior)
{
    Material window = builder_material(1);
    window.transmission = 1;
    window.roughness = 0;
    window.ior = ior;
    window.lets_light_through = true;
    return window;
}

/* The slab's transmittance, seen directly and by the light it lets fall on a wall. */
TEST(a_window_passes_what_a_slab_passes)
{
    const double degrees[] = {0, 30, 45, 60, 75},
                 slab[] = {0.918318, 0.915957, 0.902528, 0.843471, 0.614805};
    for (int i = 0; i < 5; i++) {
        World world = world_start();
        float a = (float)radians_from_degrees(degrees[i]);
        builder_part(world.scene, emitter(1000));
        builder_quad(world.scene, vec3(0, 0, -10), vec3(1, 0, 0), vec3(0, 1, 0));
        builder_part(world.scene, window_material(1.52f));
        builder_quad(world.scene, vec3(0, 0, -5),
                     vec3(4 * (float)cos((double)a), 0, 4 * (float)sin((double)a)),
                     vec3(0, 4, 0));
        world_ready(&world, BOUNCES);
        assert_luminance("window",
                         luminance(&world, vec3(0, 0, 0), vec3(0, 0, -1), 0.001f, 40000),
                         1000 * slab[i]);
        world_end(&world);
    }
}

TEST(the_sun_lights_a_wall_through_a_window)
{
    World world = world_start();
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
    builder_part(world.scene, window_material(1.52f));
    builder_quad(world.scene, vec3(0, 4, 0), vec3(50, 0, 0), vec3(0, 0, -50));
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(45);
    world.scene->environment.sun_illuminance_lx = 10000;
    world_ready(&world, BOUNCES);
    world.context.max_bounces = 1;
    assert_luminance("wall behind glass",
                     luminance(&world, vec3(0, 2, 0), vec3(0.1f, -1, 0), 0.1f, 20000),
                     10000 * sin(PI / 4) * 0.902528 * 0.5 / PI);
    world_end(&world);
}

TEST(a_mirror_of_metal_shows_its_reflectance_times_what_is_there)
{
    for (int degrees = 0; degrees <= 80; degrees += 20) {
        World world = world_start();
        Material mirror = builder_material(0.8f);
        double a = radians_from_degrees(degrees);
        mirror.metallic = 1;
        mirror.roughness = 0;
        builder_part(world.scene, mirror);
        builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
        set_sky(&world, 100);
        world_ready(&world, BOUNCES);
        Vec3 from = vec3(0, (float)cos(a), (float)sin(a));
        double schlick = 0.8 + 0.2 * pow(1 - cos(a), 5);
        assert_luminance("mirror", luminance(&world, from, vec3_neg(from), 0.001f, 4000),
                         100 * schlick);
        world_end(&world);
    }
}

TEST(a_clear_ball_in_a_uniform_sky_is_invisible)
{
    World world = world_start();
    Material glass = window_material(1.5f);
    glass.is_solid = true;
    glass.lets_light_through = false;
    builder_part(world.scene, glass);
    builder_sphere(world.scene, vec3(0, 0, 0), 1, 48, 0);
    set_sky(&world, 100);
    world_ready(&world, BOUNCES);
    assert_luminance("ball", luminance(&world, vec3(0, 0, 3), vec3(0, 0, -1), 0.6f, 20000),
                     100);
    world_end(&world);
}

/* A pane met at 70 degrees, and a film that shines as the sky does. */
TEST(sheets_in_a_uniform_sky_are_invisible)
{
    World    world = world_start();
    Material film = emitter(100);
    double   a = radians_from_degrees(70);
    film.alpha_mode = ALPHA_BLEND;
    film.base_color[3] = 0.4f;
    film.lets_light_through = film.double_sided = true;
    builder_part(world.scene, window_material(1.5f));
    builder_quad(world.scene, vec3(0, 0, -1), vec3(0.5f, 0, 0),
                 vec3(0, (float)(0.5 * cos(a)), (float)(-0.5 * sin(a))));
    builder_part(world.scene, film);
    builder_quad(world.scene, vec3(0, 0, 1), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0));
    set_sky(&world, 100);
    world_ready(&world, BOUNCES);
    for (int way = -1; way <= 1; way += 2) {
        Vec3 ahead = vec3(0, 0, (float)way);
        assert_luminance("sheet", luminance(&world, vec3(0, 0, 0), ahead, 0.1f, 20000), 100);
    }
    world_end(&world);
}

TEST(half_there_shows_half_of_what_is_behind)
{
    World world = world_start();
    Material veil = emitter(0);
    builder_part(world.scene, emitter(100));
    builder_quad(world.scene, vec3(0, 0, -2), vec3(1, 0, 0), vec3(0, 1, 0));
    veil.alpha_mode = ALPHA_BLEND;
    veil.base_color[3] = 0.25f;
    veil.lets_light_through = true;
    builder_part(world.scene, veil);
    builder_quad(world.scene, vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, 1, 0));
    world_ready(&world, BOUNCES);
    assert_luminance("veil", luminance(&world, vec3(0, 0, 0), vec3(0, 0, -1), 0.01f, 40000),
                     75);
    world_end(&world);
}

TEST(bounces_are_counted_as_documented)
{
    World world = world_start();
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(1000, 0, 0), vec3(0, 0, -1000));
    set_sky(&world, 100);
    world_ready(&world, BOUNCES);
    world.context.max_bounces = 0;
    assert_near(luminance(&world, vec3(0, 1, 0), vec3(0, -1, 0), 0.1f, 100).mean, 0, 0);
    world.context.max_bounces = 1;
    assert_luminance("one bounce",
                     luminance(&world, vec3(0, 1, 0), vec3(0, -1, 0), 0.1f, 20000), 50);
    world_end(&world);
}

TEST(the_back_of_a_one_sided_emitter_is_dark)
{
    World world = world_start();
    builder_part(world.scene, emitter(100));
    builder_quad(world.scene, vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, -1, 0));
    world_ready(&world, BOUNCES);
    assert_near(luminance(&world, vec3(0, 0, 0), vec3(0, 0, -1), 0.01f, 100).mean, 0, 0);
    world.scene->materials[0].double_sided = true;
    assert_luminance("both sides",
                     luminance(&world, vec3(0, 0, 0), vec3(0, 0, -1), 0.01f, 4000), 100);
    world_end(&world);
}

static double illuminance(const World *world, Vec3 position, Vec3 normal, int count)
{
    double sum = 0;
    PathStatistics statistics = {0};
    for (int i = 0; i < count; i++) {
        Sampler sampler = sampler_start(2, 0, 0, (uint32_t)i);
        Wavelengths w;
        float lx[3];
        wavelengths_sample(sampler_1d(&sampler), &w);
        PathStart start = {.context = &world->context, .wavelengths = &w, .sampler = &sampler,
                           .statistics = &statistics};
        path_from_point(&start, (LitPoint){position, normal, false}, lx);
        sum += (double)lx[1] / count;
    }
    return sum;
}

TEST(a_luxmeter_reads_what_falls_on_it)
{
    World world = world_start();
    builder_part(world.scene, builder_material(0));
    builder_quad(world.scene, vec3(0, -1, 0), vec3(9000, 0, 0), vec3(0, 0, -9000));
    set_sky(&world, 100);
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(30);
    world.scene->environment.sun_illuminance_lx = 1000;
    world.scene->lights[world.scene->light_count++] = (PunctualLight){
        .kind = LIGHT_POINT, .position = {0, 3, 0}, .intensity = {900, 900, 900}};
    world_ready(&world, BOUNCES);
    assert_close(illuminance(&world, vec3(0, 0, 0), vec3(0, 1, 0), 20000),
                 PI * 100 + 1000 * 0.5 + 900 / 9.0, 2e-3);
    assert_near(illuminance(&world, vec3(0, -0.5f, 0), vec3(0, -1, 0), 4000), 0, 1e-3);
    world_end(&world);
}

/* The ray meets the diagonal that both triangles of the pane share: one pane, tinted once. */
TEST(a_pane_is_passed_once_on_the_edge_of_its_triangles)
{
    World world = world_start();
    builder_part(world.scene, builder_material(0));
    builder_quad(world.scene, vec3(0, -1, 0), vec3(5, 0, 0), vec3(0, 0, -5));
    builder_part(world.scene, window_material(1.52f));
    builder_quad(world.scene, vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, -1));
    world.scene->lights[world.scene->light_count++] = (PunctualLight){
        .kind = LIGHT_POINT, .position = {0, 2, 0}, .intensity = {400, 400, 400}};
    world_ready(&world, BOUNCES);
    assert_close(illuminance(&world, vec3(0, 0, 0), vec3(0, 1, 0), 4000), 100 * 0.918318, 2e-3);
    world_end(&world);
}

TEST_PROGRAM(NULL, NULL)
