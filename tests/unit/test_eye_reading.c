/* SPDX-License-Identifier: Apache-2.0 */
/* The veil that stray light lays over a gaze point, against its formula. */
#include "fixture.h"

#include "base/units.h"
#include "review/eye/eye_reading.h"
#include "vision/eye_filter.h"
#include "vision/eye_spread.h"
#include "world_fixture.h"

static ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};
static const HumanEye whose = {50, 0.5};
static const Vec3 at = {0, 0, -1}; /* looked at from the origin */

static EyeReading read_look(World *world, EyeLook look) {
    const Kernel *kernel;
    assert_done(kernel_choose(NULL, &kernel, &err));
    if (!world->bvh) world_ready(world, 16); /* a test may look twice */
    Setup setup = {.request = &request,
                   .tools = {.kernel = kernel, .threads = 2},
                   .scene = world->scene,
                   .context = world->context};
    return eye_read(&setup, &look, world->arena);
}

static EyeReading read_towards(World *world, Vec3 towards, int rounds) {
    return read_look(world, (EyeLook){vec3(0, 0, 0), towards, rounds, NULL, false, NULL});
}

static EyeReading read_eye(World *world) {
    return read_towards(world, at, 1);
}

/* Above the line of sight. */
static Vec3 at_angle(double degrees) {
    double t = radians_from_degrees(degrees);
    return vec3(0, (float)sin(t), (float)-cos(t));
}

/* Of light of D65. */
static void assert_white(EyeReading found) {
    assert_close(found.beside[0], 0.95047 * found.veil, 0.01);
    assert_close(found.beside[1], 1.08883 * found.veil, 0.01);
}

static void assert_veil(EyeReading found, double degrees, double lux) {
    double wanted = lux * eye_spread_at(degrees, whose);
    if (!(fabs(found.veil / wanted - 1) < 0.01))
        fail_msg("%g degrees: veil %g, required: %g", degrees, found.veil, wanted);
}

/* A black world, but for what a test adds. */
static World dark_world(void) {
    World world = world_start();
    builder_part(world.scene, builder_material(0));
    builder_quad(world.scene, vec3(0, -100, 0), vec3(1, 0, 0), vec3(0, 0, -1));
    return world;
}

TEST(a_small_source_veils_by_its_illuminance_of_the_pupil) {
    static const double angles[] = {1, 2, 5, 10, 30, 60, 85};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        SCOPED_WORLD world = dark_world();
        double half = 0.0005, t = radians_from_degrees(angles[i]);
        builder_part(world.scene, builder_lamp(1e5f));
        Vec3 d = at_angle(angles[i]);
        Vec3 up = vec3(0, (float)(half * cos(t)), (float)(half * sin(t)));
        builder_quad(world.scene, d, vec3((float)half, 0, 0), up);
        if (vec3_dot(vec3_cross(vec3(1, 0, 0), up), d) > 0) fail_msg("the lamp looks away");
        assert_veil(read_eye(&world), angles[i], 1e5 * 4 * half * half * cos(t));
    }
}

/* The luminance in the middle of a picture, 64 x 3 pixels of 1 degree there, of one bright
 * pixel; *angle_deg: of that from the middle, *lux: that it brings to what faces it. */
static double veil_in_picture(int at_x, HumanEye eye, Arena scratch, double *angle_deg,
                              double *lux) {
    enum { WIDE = 64, HIGH = 3 };
    const double pixel = radians_from_degrees(1);
    const EyeFilter filter = {{WIDE, HIGH, 32.5, 1.5, pixel}, eye, 1};
    static float light[WIDE * HIGH], seen[3][WIDE * HIGH];
    EyeLayer layer = {{light, light, light}, {seen[0], seen[1], seen[2]}};
    for (int i = 0; i < WIDE * HIGH; i++) light[i] = 0;
    light[WIDE + at_x] = 1e6f;
    double tangent = (at_x - 32) * pixel;
    assert_done(eye_filter(&filter, &layer, 1, scratch, &err));
    *angle_deg = degrees_from_radians(atan(fabs(tangent)));
    *lux = 1e6 * pixel * pixel / pow(1 + tangent * tangent, 1.5);
    return (double)seen[1][WIDE + 32];
}

/* A lamp in a frame, before a gaze, and in the formula of verdicts: one veil. The gaze's lux
 * are those of its pupil. */
TEST(frames_and_gazes_have_one_veil) {
    static const HumanEye eyes[] = {{25, 0.5}, {60, 0.5}, {75, 1.2}};
    static const int places[] = {12, 22, 52, 63};
    const HumanEye before = request.observer;
    for (int i = 0; i < 12; i++) {
        SCOPED_WORLD world = dark_world();
        double angle, lux;
        HumanEye eye = eyes[i / 4];
        double in_frame = veil_in_picture(places[i % 4], eye, world.arena, &angle, &lux);
        request.observer = eye;
        world.scene->lights[world.scene->light_count++] =
            (PunctualLight){.name = "lamp",
                            .kind = LIGHT_POINT,
                            .position = at_angle(angle),
                            .intensity = {(float)lux, (float)lux, (float)lux},
                            .level = 1};
        double by_gaze = read_eye(&world).veil / cos(radians_from_degrees(angle));
        assert_close(in_frame, lux * eye_spread_at(angle, eye), 6e-3); /* a pixel's mean */
        assert_close(by_gaze, in_frame, 1e-2);
    }
    request.observer = before;
}

TEST(a_lamp_without_a_body_veils_alike) {
    SCOPED_WORLD world = dark_world();
    world.scene->lights[world.scene->light_count++] = (PunctualLight){.name = "lamp",
                                                                      .kind = LIGHT_POINT,
                                                                      .position = at_angle(20),
                                                                      .intensity = {300, 300, 300},
                                                                      .level = 1};
    EyeReading found = read_eye(&world);
    double lux = 300 * cos(radians_from_degrees(20));
    assert_veil(found, 20, lux);
    assert_near(found.vertical_lx, lux, 0.01 * lux);
    assert_near(found.parts[EYE_LAMPS], found.veil, 1e-9 * found.veil);
}

TEST(the_sun_veils_by_its_own_angle) {
    SCOPED_WORLD world = dark_world();
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(15);
    world.scene->environment.sun_illuminance_lx = 50000;
    EyeReading found = read_eye(&world);
    double lux = 50000 * cos(radians_from_degrees(15));
    assert_veil(found, 15, lux);
    if (!(fabs(found.vertical_lx / lux - 1) < 0.01)) fail_msg("%g lx", found.vertical_lx);
    assert_near(found.parts[EYE_SUN], found.veil, 1e-9 * found.veil);
}

/* Before the eye, from in front of it to above it: it takes and mirrors a share of the sun. */
TEST(glass_takes_what_it_mirrors_of_the_sun) {
    static const double passed = 0.902528; /* of 1.52 at 45 degrees: Fresnel, both faces */
    SCOPED_WORLD world = dark_world();
    Material window = builder_material(1);
    double a = radians_from_degrees(15 + 45);
    window.transmission = 1;
    window.roughness = 0;
    window.ior = 1.52f;
    window.lets_light_through = true;
    builder_part(world.scene, window);
    builder_quad(world.scene, at_angle(15), vec3(1, 0, 0), vec3(0, (float)cos(a), (float)sin(a)));
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(15);
    world.scene->environment.sun_illuminance_lx = 90000;
    EyeReading found = read_eye(&world);
    assert_veil(found, 15, 90000 * passed * cos(radians_from_degrees(15)));
}

/* A mirror of a metre, 2 m away, shows the sun that stands behind the eye at 20 degrees from
 * the gaze; paths would find it by luck. Some 22 rays look into the disc, one more or less. */
TEST(an_image_of_the_sun_veils_by_its_illuminance) {
    const Kernel *kernel;
    float bands[LIGHT_BANDS];
    Vec3 towards, d = at_angle(20);
    FalseSunRays rays;
    SCOPED_WORLD world = dark_world();
    builder_part(world.scene, builder_mirror(0.8f));
    builder_quad(world.scene, vec3_scale(d, 2), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0));
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_azimuth = (float)PI;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(20);
    world.scene->environment.sun_illuminance_lx = 60000;
    assert_done(kernel_choose(NULL, &kernel, &err));
    world_ready(&world, 16);
    Setup setup = {.request = &request,
                   .tools = {.kernel = kernel, .threads = 2},
                   .scene = world.scene,
                   .context = world.context};
    assert_true(setup_sun(&setup, &towards, bands));
    false_suns_search(&setup, vec3(0, 0, 0), &world.arena, &rays);
    FalseSuns images = false_suns_of(&rays, bands, &world.arena);
    EyeLook look = {vec3(0, 0, 0), at, 4, &images, false, NULL};
    EyeReading found = eye_read(&setup, &look, world.arena);
    double lux = 0.8 * 60000 * cos(radians_from_degrees(20));
    double wanted = lux * eye_spread_at(20, whose);
    assert_near(found.parts[EYE_GLINTS], wanted, wanted / 22);
    assert_near(found.veil, wanted, wanted / 22);
    assert_near(found.vertical_lx, lux, lux / 22);
    assert_true(found.veil_sigma > 0 && found.veil_sigma < 0.3 * wanted);
}

/* f L cos theta over the half space in front, by quadrature. */
TEST(a_uniform_sky_veils_by_the_integral) {
    SCOPED_WORLD world = dark_world();
    double sum = 0, step = 0.01;
    builder_sky(world.scene, 100);
    for (double d = 0.1 + step / 2; d < 90; d += step) {
        double t = radians_from_degrees(d);
        sum += eye_spread_at(d, whose) * cos(t) * sin(t) * radians_from_degrees(step) * 2 * PI;
    }
    EyeReading found = read_eye(&world);
    if (!(fabs(found.veil / (100 * sum) - 1) < 0.01))
        fail_msg("veil %g, required: %g", found.veil, 100 * sum);
    assert_white(found);
    if (!(fabs(found.vertical_lx / (100 * PI) - 1) < 0.01)) fail_msg("%g lx", found.vertical_lx);
}

/* A sky, a lamp and a white floor that both light. */
static World lit_world(void) {
    World world = world_start();
    builder_part(world.scene, builder_material(0.8f));
    builder_quad(world.scene, vec3(0, -1, 0), vec3(3, 0, 0), vec3(0, 0, -3));
    builder_sky(world.scene, 100);
    world.scene->lights[world.scene->light_count++] = (PunctualLight){.name = "lamp",
                                                                      .kind = LIGHT_POINT,
                                                                      .position = at_angle(20),
                                                                      .intensity = {300, 300, 300},
                                                                      .level = 1};
    return world;
}

TEST(parts_of_a_veil_add_up_and_rounds_agree) {
    SCOPED_WORLD world = lit_world();
    EyeReading once = read_towards(&world, at, 1), often = read_towards(&world, at, 16);
    double sum = 0;
    for (int i = 0; i < EYE_SOURCES; i++) sum += often.parts[i];
    assert_near(sum, often.veil, 1e-9 * sum);
    assert_true(often.parts[EYE_SKY] > 0 && often.parts[EYE_LAMPS] > 0 &&
                often.parts[EYE_SURFACES] > 0 && often.parts[EYE_NEAR] > 0);
    assert_true(often.parts[EYE_SUN] == 0 && often.parts[EYE_GLINTS] == 0);
    assert_true(isnan(once.veil_sigma) && often.veil_sigma > 0);
    assert_true(often.veil_sigma < 0.002 * often.veil);
    assert_white(often);
    assert_near(once.veil, often.veil, 5 * 4 * often.veil_sigma); /* a round's: 4 times */
}

TEST(an_older_eye_has_more_veil) {
    SCOPED_WORLD world = lit_world();
    double last = 0;
    for (int age = 20; age <= 80; age += 30) {
        request.observer.age_years = age;
        double veil = read_eye(&world).veil;
        assert_true(veil > 1.01 * last);
        last = veil;
    }
    request.observer.age_years = 50;
}

TEST(eyes_look_straight_up_and_down) {
    SCOPED_WORLD world = lit_world();
    for (int sign = -1; sign <= 1; sign += 2) {
        EyeReading found = read_towards(&world, vec3(0, (float)sign, 0), 1);
        assert_true(found.veil > 0);
    }
}

/* Under a sky beside a lamp, as near as may be and far: two ages tell all others. */
TEST(veils_are_a_line_over_aging) {
    static const double ages[] = {25, 50, 75};
    const HumanEye before = request.observer;
    SCOPED_WORLD world = dark_world();
    double veil[3], aging[3];
    builder_sky(world.scene, 200);
    builder_part(world.scene, builder_lamp(1e5f));
    builder_quad(world.scene, vec3(0, 0.01f, -1), vec3(0.01f, 0, 0), vec3(0, 0.01f, 0));
    for (int i = 0; i < 3; i++) {
        request.observer.age_years = ages[i];
        aging[i] = eye_spread_aging(ages[i]);
        veil[i] = read_look(&world, (EyeLook){vec3(0, 0, 0), at, 2, NULL, true, NULL}).veil;
    }
    request.observer = before;
    double share = (aging[1] - aging[0]) / (aging[2] - aging[0]);
    assert_true(veil[2] > 1.05 * veil[0]);
    assert_close(veil[1], veil[0] + share * (veil[2] - veil[0]), 1e-12);
}

/* f L cos theta over a square before the gaze, by rings that widen evenly, from 0.1 degrees on:
 * of those that reach beyond its sides four arcs. */
static double veil_of_square(double half, double cd_m2) {
    double sum = 0, end = half * sqrt(2), ratio = 1.0005;
    for (double r = tan(radians_from_degrees(0.1)); r < end; r *= ratio) {
        double middle = r * sqrt(ratio), width = r * (ratio - 1);
        double beyond = middle > half ? 8 * acos(half / middle) : 0;
        double f = eye_spread_at(degrees_from_radians(atan(middle)), whose);
        sum += f * middle * width * (2 * PI - beyond) / pow(1 + middle * middle, 2);
    }
    return cd_m2 * sum;
}

/* A display that is looked at: light samples, spread over all of it, seldom meet what weighs
 * most. */
TEST(a_close_reading_knows_what_is_looked_at) {
    const double half = 0.15, cd_m2 = 300;
    SCOPED_WORLD world = dark_world();
    builder_part(world.scene, builder_lamp((float)cd_m2));
    builder_quad(world.scene, at, vec3((float)half, 0, 0), vec3(0, (float)half, 0));
    double wanted = veil_of_square(half, cd_m2);
    EyeReading close = read_look(&world, (EyeLook){vec3(0, 0, 0), at, 4, NULL, true, NULL});
    EyeReading plain = read_towards(&world, at, 4);
    assert_close(close.veil, wanted, 0.002);
    assert_white(close);
    assert_true(close.veil_range.low < wanted && wanted < close.veil_range.high);
    assert_close(close.parts[EYE_LAMPS], close.veil, 1e-12);
    assert_true(close.veil_sigma < 0.2 * plain.veil_sigma);
    assert_close(close.vertical_lx, plain.vertical_lx, 1e-12);
}

/* Nothing is counted twice, or lost: neither what lies farther nor a lamp without a body. */
TEST(a_close_reading_leaves_the_rest_alone) {
    SCOPED_WORLD world = dark_world();
    builder_part(world.scene, builder_lamp(1e5f));
    builder_quad(world.scene, at_angle(20), vec3(0.001f, 0, 0), vec3(0, 0.001f, 0));
    world.scene->lights[world.scene->light_count++] = (PunctualLight){.name = "lamp",
                                                                      .kind = LIGHT_POINT,
                                                                      .position = at_angle(2),
                                                                      .intensity = {30, 30, 30},
                                                                      .level = 1};
    EyeReading close = read_look(&world, (EyeLook){vec3(0, 0, 0), at, 2, NULL, true, NULL});
    EyeReading plain = read_towards(&world, at, 2);
    assert_close(close.veil, plain.veil, 1e-12);
    assert_true(close.veil > 0);
    assert_white(close);
}

TEST_PROGRAM(NULL, NULL)
