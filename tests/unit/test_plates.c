/* SPDX-License-Identifier: Apache-2.0 */

#include "base/units.h"
#include "world_fixture.h"

enum { BOUNCES = 64 };

/* ---- a plate, and what it does ----------------------------------------------------------- */

typedef struct Slab {
    double index, thickness, tilt; /* m; radians about x, from lying across z */
    double z;                      /* of its middle, on the z axis */
    double left;                   /* of the light after 10 mm */
} Slab;

#define HALF_WIDTH 3.0f

static Material glass_of(const Slab *slab) {
    Material glass = builder_pane((float)slab->index);
    glass.is_solid = true;
    glass.lets_light_through = false;
    if (!(slab->left < 1)) return glass;
    for (int i = 0; i < 3; i++) glass.attenuation_color[i] = (float)slab->left;
    glass.attenuation_distance_m = 0.01f;
    return glass;
}

static Vec3 normal_of(const Slab *slab) {
    return vec3(0, (float)-sin(slab->tilt), (float)cos(slab->tilt));
}

/* A closed box; wedge: radians between its two large faces. */
static void add_slab(Scene *scene, const Slab *slab, double wedge) {
    Vec3 n = normal_of(slab), x = vec3(HALF_WIDTH, 0, 0);
    Vec3 y = vec3_scale(vec3_cross(n, vec3(1, 0, 0)), HALF_WIDTH);
    Vec3 middle = vec3(0, 0, (float)slab->z), half = vec3_scale(n, (float)slab->thickness / 2);
    Vec3 lean = vec3_scale(n, (float)(HALF_WIDTH * tan(wedge)));
    builder_part(scene, glass_of(slab));
    builder_quad(scene, vec3_add(middle, half), x, vec3_add(y, lean));
    builder_quad(scene, vec3_sub(middle, half), vec3_neg(x), y);
    builder_quad(scene, vec3_add(middle, x), vec3_neg(y), half);
    builder_quad(scene, vec3_sub(middle, x), y, half);
    builder_quad(scene, vec3_add(middle, y), x, vec3_neg(half));
    builder_quad(scene, vec3_sub(middle, y), x, half);
}

/* Share that passes at the sine, after `turns` turns inside or, below 0, in all. */
static double passed_at(const Slab *slab, double sine, int turns) {
    double n = slab->index, c = sqrt(1 - sine * sine), in = sqrt(1 - sine * sine / (n * n));
    double s = (c - n * in) / (c + n * in), p = (n * c - in) / (n * c + in), sum = 0;
    double body = pow(slab->left, slab->thickness / 0.01 / in);
    for (int i = 0; i < 2; i++) {
        double r = i ? p * p : s * s, turn = r * r * body * body;
        double first = 0.5 * (1 - r) * (1 - r) * body;
        sum += turns < 0 ? first / (1 - turn) : first * pow(turn, turns);
    }
    return sum;
}

/* ---- lamps ------------------------------------------------------------------------------- */

typedef struct LampCase {
    Slab slab;
    double lamp[3], tilt; /* m; of the plane at the origin that it lights, about x */
} LampCase;

/* Beside the normal, where light leaves the origin at that angle, at the lamp's height. */
static double lands_at(const Slab *slab, double height, double through, double sine) {
    double n = slab->index;
    return (height - through) * sine / sqrt(1 - sine * sine) +
           through * sine / sqrt(n * n - sine * sine);
}

/* lx of 1000 cd on the plane, by halving and by differences: nothing of the program's way. */
static double closed_form(const LampCase *at) {
    const Slab *slab = &at->slab;
    Vec3 n3 = normal_of(slab);
    double n[3] = {0, (double)n3.y, (double)n3.z}, height = 0, beside[3], rho = 0, sum = 0;
    for (int k = 0; k < 3; k++) height += n[k] * at->lamp[k];
    for (int k = 0; k < 3; k++) {
        beside[k] = at->lamp[k] - height * n[k];
        rho += beside[k] * beside[k];
    }
    rho = sqrt(rho);
    for (int turns = 0; turns < 6; turns++) {
        double through = slab->thickness * (1 + 2 * turns), low = 0, high = 1;
        double air = height - slab->thickness, step = 1e-6;
        for (int i = 0; i < 200; i++) {
            double sine = (low + high) / 2;
            *(lands_at(slab, air + through, through, sine) < rho ? &low : &high) = sine;
        }
        double cosine = sqrt(1 - low * low);
        double grows = (lands_at(slab, air + through, through, low + step) -
                        lands_at(slab, air + through, through, low - step)) /
                       (2 * step) * cosine;
        double cos_plane = 0, plane[3] = {0, -sin(at->tilt), cos(at->tilt)};
        for (int k = 0; k < 3; k++)
            cos_plane += plane[k] * (cosine * n[k] + (rho > 0 ? low * beside[k] / rho : 0));
        sum += 1000 * passed_at(slab, low, turns) * cos_plane * low / (rho * cosine * grows);
    }
    return sum;
}

static void assert_lamp_case(int i) {
    SCOPED_WORLD world = world_start();
    Sampler sampler = sampler_start(7, i, 0, 0);
    float u[8];
    for (int k = 0; k < 8; k++) u[k] = sampler_1d(&sampler);
    LampCase at = {{1.3 + 0.6 * (double)u[0], 0.002 + 0.03 * (double)u[1],
                    radians_from_degrees(-50 + 100 * (double)u[2]), 0.4,
                    u[7] < 0.5f ? 1 : 0.4 + 0.5 * (double)u[7]},
                   {-0.5 + (double)u[3], -0.4 + 0.8 * (double)u[4], 1.2 + (double)u[5]},
                   radians_from_degrees(-30 + 60 * (double)u[6])};
    add_slab(world.scene, &at.slab, 0);
    world.scene->lights[world.scene->light_count++] =
        (PunctualLight){.kind = LIGHT_POINT, .intensity = {1000, 1000, 1000}};
    world.scene->lights[0].position = vec3_from_doubles(at.lamp);
    world_ready(&world, BOUNCES);
    Vec3 plane = vec3(0, (float)-sin(at.tilt), (float)cos(at.tilt));
    WorldMean found = world_measure(&world, (Gauge){vec3(0, 0, 0), plane, 0, true}, 3, 512);
    double expected = closed_form(&at);
    if (!(fabs(found.mean - expected) <= 2e-3 * expected + 3.5 * found.sigma))
        fail_msg("case %d: %g +- %g lx, expected %g", i, found.mean, found.sigma, expected);
}

TEST(a_lamp_behind_a_plate_lights_as_refraction_has_it) {
    for (int i = 0; i < (all_laws() ? 200 : 50); i++) assert_lamp_case(i);
}

TEST(plates_one_behind_the_other_are_passed) {
    SCOPED_WORLD world = world_start();
    Slab one = {1.5, 0.01, 0, 0.4, 1}, other = {1.7, 0.02, 0, 0.8, 0.6};
    add_slab(world.scene, &one, 0);
    add_slab(world.scene, &other, 0);
    world.scene->lights[world.scene->light_count++] =
        (PunctualLight){.kind = LIGHT_POINT, .position = {0, 0, 2}, .intensity = {400, 400, 400}};
    world_ready(&world, BOUNCES);
    double d = 2 - 0.01 * (1 - 1 / 1.5) - 0.02 * (1 - 1 / 1.7);
    double expected = 400 / (d * d) * passed_at(&one, 0, -1) * passed_at(&other, 0, -1);
    double found =
        world_measure(&world, (Gauge){vec3(0, 0, 0), vec3(0, 0, 1), 0, true}, 3, 4000).mean;
    assert_close(found, expected, 1e-3);
}

/* ---- the sun, the sky -------------------------------------------------------------------- */

/* Light of a sun at 50 degrees from the plate's normal, on a plane that faces the plate. */
TEST(the_sun_through_a_plate_is_found_alike_by_all_strategies) {
    SCOPED_WORLD world = world_start();
    Slab slab = {1.5, 0.02, radians_from_degrees(20), 0.3, 0.7};
    double elevation = radians_from_degrees(40);
    WorldMean found[3];
    add_slab(world.scene, &slab, 0);
    world.scene->environment.forward = vec3(0, 0, 1);
    builder_sun(world.scene, 0, elevation, 10000);
    world.scene->environment.sun_angular_radius = 0.3f;
    world_ready(&world, BOUNCES);
    Gauge head = {vec3(0, 0, 0), vec3(0, 0, 1), 0, true};
    for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
        world.context.strategy = s;
        found[s] = world_measure(&world, head, 5, s == PATH_BSDF_ONLY ? 400000 : 40000);
        if (!(found[s].sigma <= 0.01 * found[s].mean)) fail_msg("strategy %d says nothing", s);
        if (fabs(found[s].mean - found[0].mean) > 3.5 * hypot(found[s].sigma, found[0].sigma))
            fail_msg("strategy %d: %g +- %g, all: %g +- %g", s, found[s].mean, found[s].sigma,
                     found[0].mean, found[0].sigma);
    }
}

/* At 0 to 75 degrees to the plate's normal. */
TEST(a_narrow_sun_comes_through_a_plate_by_the_slab) {
    for (int degrees = 0; degrees <= 75; degrees += 15) {
        SCOPED_WORLD world = world_start();
        Slab slab = {1.5, 0.01, radians_from_degrees(degrees - 60), 0.4, 0.8};
        add_slab(world.scene, &slab, 0);
        world.scene->environment.forward = vec3(0, 0, 1);
        builder_sun(world.scene, 0, radians_from_degrees(60), 10000);
        world_ready(&world, BOUNCES);
        double expected = 5000 * passed_at(&slab, sin(radians_from_degrees(degrees)), -1);
        WorldMean found =
            world_measure(&world, (Gauge){vec3(0, 0, 0), vec3(0, 0, 1), 0, true}, 3, 20000);
        if (!(fabs(found.mean - expected) <= 2e-3 * expected + 3.5 * found.sigma))
            fail_msg("%d degrees: %g +- %g lx, expected %g", degrees, found.mean, found.sigma,
                     expected);
    }
}

/* Seen directly, and by the light that it lets fall on a wall: a slab of each polarisation. */
TEST(a_plate_passes_what_a_slab_passes) {
    for (int degrees = 0; degrees <= 75; degrees += 15) {
        SCOPED_WORLD world = world_start();
        Slab slab = {1.5, 0.01, radians_from_degrees(degrees), 0.4, 0.8};
        add_slab(world.scene, &slab, 0);
        builder_part(world.scene, builder_lamp(1000));
        builder_quad(world.scene, vec3(0, 0, 3), vec3(0.3f, 0, 0), vec3(0, -0.3f, 0));
        world_ready(&world, BOUNCES);
        double expected = 1000 * passed_at(&slab, sin(radians_from_degrees(degrees)), -1);
        WorldMean found =
            world_measure(&world, (Gauge){vec3(0, 0, 0), vec3(0, 0, 1), 0.001f, false}, 3, 4000);
        if (!(fabs(found.mean - expected) <= 2e-3 * expected + 3.5 * found.sigma))
            fail_msg("%d degrees: %g +- %g, expected %g", degrees, found.mean, found.sigma,
                     expected);
    }
}

/* Sky, and a lamp with a surface: chance and light samples share them. */
TEST(a_plate_in_a_uniform_sky_is_invisible) {
    SCOPED_WORLD world = world_start();
    Slab slab = {1.5, 0.02, radians_from_degrees(30), 0.3, 1};
    add_slab(world.scene, &slab, 0);
    builder_sky(world.scene, 100);
    world_ready(&world, BOUNCES);
    for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
        world.context.strategy = s;
        WorldMean found =
            world_measure(&world, (Gauge){vec3(0, 0, 0), vec3(0, 0, 1), 0, true}, 3, 40000);
        if (!(fabs(found.mean - 100 * PI) <= 1e-3 * 100 * PI + 3.5 * found.sigma))
            fail_msg("strategy %d: %g +- %g lx", s, found.mean, found.sigma);
    }
}

/* ---- what is no plate -------------------------------------------------------------------- */

/* Light of a lamp that no way is known through is said to be lost. */
static double lost_behind(void (*add)(Scene *scene)) {
    SCOPED_WORLD world = world_start();
    PathStatistics statistics = {0};
    float xyz[3];
    add(world.scene);
    world.scene->lights[world.scene->light_count++] =
        (PunctualLight){.kind = LIGHT_POINT, .position = {0, 0, 2}, .intensity = {400, 400, 400}};
    world_ready(&world, BOUNCES);
    for (uint32_t i = 0; i < 256; i++) {
        Sampler sampler = sampler_start(1, 0, 0, i);
        Wavelengths w;
        wavelengths_sample(sampler_1d(&sampler), &w);
        PathStart start = {.context = &world.context,
                           .wavelengths = &w,
                           .sampler = &sampler,
                           .statistics = &statistics};
        path_from_point(&start, (LitPoint){vec3(0, 0, 0), vec3(0, 0, 1), false}, xyz);
    }
    return statistics.lost / 256;
}

static void add_wedge(Scene *scene) {
    add_slab(scene, &(Slab){1.5, 0.2, 0, 0.5, 1}, radians_from_degrees(1));
}

static void add_ball(Scene *scene) {
    builder_part(scene, glass_of(&(Slab){.index = 1.5, .left = 1}));
    builder_sphere(scene, vec3(0, 0, 1), 0.3f, 24, 0);
}

static void add_plate(Scene *scene) {
    add_slab(scene, &(Slab){1.5, 0.2, 0, 0.5, 1}, 0);
}

static void add_ball_and_wall(Scene *scene) {
    add_ball(scene);
    builder_part(scene, builder_material(0));
    builder_quad(scene, vec3(0, 0, 1.5f), vec3(1, 0, 0), vec3(0, 1, 0));
}

TEST(light_that_no_way_is_known_for_is_counted) {
    assert_true(lost_behind(add_wedge) > 99);
    assert_true(lost_behind(add_ball) > 99);
    assert_near(lost_behind(add_plate), 0, 0);
    assert_near(lost_behind(add_ball_and_wall), 0, 0);
}

TEST_PROGRAM(NULL, NULL)
