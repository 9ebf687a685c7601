/* SPDX-License-Identifier: Apache-2.0 */
/* What an eye sees along its gaze, and what a pane mirrors over it, against closed forms. */
#include "fixture.h"

#include "base/units.h"
#include "review/eye/gaze_reading.h"
#include "world_fixture.h"

#define REFLECTANCE 0.2f
#define SUN_LX 80000.0f
#define SUN_DEG 40.0

static const ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};

static GazeReading read_gaze(World *world) {
    const Kernel *kernel;
    assert_done(kernel_choose(NULL, &kernel, &err));
    world_ready(world, 16);
    Setup setup = {.request = &request,
                   .tools = {.kernel = kernel, .threads = 2},
                   .scene = world->scene,
                   .context = world->context};
    GazeGoal goal = {vec3(0, 0, 0), vec3(0, 0, -2), 0.002, 1 << 17};
    return gaze_read(&setup, &goal, world->arena);
}

static Material glass(void) {
    Material glass = builder_material(1);
    glass.transmission = 1;
    glass.roughness = 0;
    glass.ior = 1.52f;
    return glass;
}

/* The sun stands to the right, so that no pane shades what is seen via it. */
static World sunny_world(void) {
    World world = world_start();
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_azimuth = (float)(PI / 2);
    world.scene->environment.sun_elevation = (float)radians_from_degrees(SUN_DEG);
    world.scene->environment.sun_illuminance_lx = SUN_LX;
    return world;
}

/* Part 0 of a world: below the gaze. */
static void add_dashboard(World *world) {
    builder_part(world->scene, builder_material(REFLECTANCE));
    builder_quad(world->scene, vec3(0, -0.5f, 0), vec3(10, 0, 0), vec3(0, 0, -10));
}

static double dashboard_cd_m2(void) {
    return (double)REFLECTANCE / PI * (double)SUN_LX * sin(radians_from_degrees(SUN_DEG));
}

/* A pane of half a decimetre across the gaze, 1 m away, that leans over the dashboard. */
static void add_sheet(World *world, double degrees, double distance, bool faces_eye) {
    double a = radians_from_degrees(degrees), sign = faces_eye ? 1 : -1;
    Vec3 normal = vec3(0, (float)-sin(a), (float)cos(a));
    Vec3 along = vec3(0, (float)(0.15 * sign * cos(a)), (float)(0.15 * sign * sin(a)));
    builder_quad(world->scene, vec3_along(vec3(0, 0, -1), normal, (float)-distance),
                 vec3(0.05f, 0, 0), along);
}

static void add_pane(World *world, double degrees) {
    Material pane = glass();
    pane.lets_light_through = true;
    builder_part(world->scene, pane);
    add_sheet(world, degrees, 0, true);
}

static void add_solid_pane(World *world) {
    Material pane = glass();
    pane.is_solid = true;
    builder_part(world->scene, pane);
    add_sheet(world, 60, 0, true);
    add_sheet(world, 60, 0.002, false);
}

static void assert_mirrored(const GazeReading *found, double wanted) {
    double off = fabs(found->mirrored.mean - wanted);
    if (!(off < fmax(0.01 * wanted, 3 * found->mirrored.sigma) && off < 0.02 * wanted))
        fail_msg("mirrored %g +- %g, required: %g", found->mirrored.mean, found->mirrored.sigma,
                 wanted);
}

TEST(a_pane_mirrors_the_dashboard_by_fresnel) {
    /* Both faces and all that goes to and fro between them, each polarisation by itself. */
    static const double degrees[] = {45, 60, 70};
    static const double passed[] = {0.902528, 0.843471, 0.724713};
    for (int i = 0; i < 3; i++) {
        SCOPED_WORLD world = sunny_world();
        add_dashboard(&world);
        add_pane(&world, degrees[i]);
        GazeReading found = read_gaze(&world);
        assert_mirrored(&found, (1 - passed[i]) * dashboard_cd_m2());
        assert_true(found.through.mean == 0);
        assert_int_equal(found.most.pane_id, 1);
        assert_int_equal(found.most.part_id, 0);
    }
}

/* As thin ones do, but for what the far face mirrors beside the rim. */
TEST(a_pane_with_thickness_mirrors_by_both_faces) {
    SCOPED_WORLD world = sunny_world();
    add_dashboard(&world);
    add_solid_pane(&world);
    GazeReading found = read_gaze(&world);
    assert_mirrored(&found, (1 - 0.843471) * dashboard_cd_m2());
    assert_int_equal(found.most.pane_id, 1);
    assert_int_equal(found.most.part_id, 0);
}

TEST(what_lies_behind_a_pane_comes_through_it) {
    SCOPED_WORLD world = world_start();
    builder_part(world.scene, builder_lamp(500));
    builder_quad(world.scene, vec3(0, 0, -3), vec3(1, 0, 0), vec3(0, 1, 0));
    add_pane(&world, 60);
    GazeReading found = read_gaze(&world);
    assert_near(found.through.mean, 500 * 0.843471, 500 * 0.843471 * 0.01);
    assert_true(found.mirrored.mean == 0 && found.most.pane_id == NO_ID);
}

/* Chrome is what the eye looks at, not something that lies before it. */
TEST(a_mirror_is_no_pane) {
    SCOPED_WORLD world = sunny_world();
    add_dashboard(&world);
    builder_part(world.scene, builder_mirror(1));
    add_sheet(&world, 60, 0, true);
    GazeReading found = read_gaze(&world);
    assert_true(found.mirrored.mean == 0 && found.most.pane_id == NO_ID);
    assert_near(found.through.mean, dashboard_cd_m2(), 0.01 * dashboard_cd_m2());
}

/* The sun's disc within the cone is no background; all else is. */
TEST(the_sun_itself_is_not_looked_at) {
    SCOPED_WORLD world = sunny_world();
    add_dashboard(&world);
    world.scene->environment.sun_azimuth = 0;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(0.5);
    GazeReading found = read_gaze(&world);
    assert_true(found.through.mean == 0 && found.mirrored.mean == 0);
}

/* Nor through a windscreen, with a thickness or without. */
TEST(the_sun_behind_a_pane_is_not_looked_at) {
    for (int is_solid = 0; is_solid < 2; is_solid++) {
        SCOPED_WORLD world = sunny_world();
        world.scene->environment.sun_azimuth = 0;
        world.scene->environment.sun_elevation = (float)radians_from_degrees(0.5);
        if (is_solid) add_solid_pane(&world);
        else add_pane(&world, 60);
        GazeReading found = read_gaze(&world);
        if (!(found.through.mean == 0))
            fail_msg("%s: %g cd/m2", is_solid ? "solid" : "thin", found.through.mean);
    }
}

/* ---- light that is rare ------------------------------------------------------------------ */

#define RARE_RUNS 100
#define RARE_CD_M2 1e7f
#define RARE_HALF 0.0006f /* m */
#define RARE_M 2.5        /* from the eye to the pane, and on to the lamp */

/* A small lamp behind the eye, in a pane across the gaze under an even sky. */
static World rare_world(double *wanted) {
    World world = world_start();
    double r = 0.52 / 2.52, mirrored = 2 * r * r / (1 + r * r);
    double cone = 2 * PI * (1 - cos(radians_from_degrees(GAZE_CONE_DEG)));
    double sr = 4 * (double)RARE_HALF * (double)RARE_HALF / (RARE_M * RARE_M);
    builder_sky(world.scene, 100);
    builder_part(world.scene, builder_lamp(RARE_CD_M2));
    builder_quad(world.scene, vec3(0.02f, 0.01f, (float)RARE_M - 2), vec3(-RARE_HALF, 0, 0),
                 vec3(0, RARE_HALF, 0));
    add_pane(&world, 0);
    *wanted = mirrored * (100 + (double)RARE_CD_M2 * sr / cone);
    return world;
}

static GazeReading read_seed(const World *world, int most, uint64_t seed) {
    ReviewRequest own = request;
    Setup setup = {
        .request = &own, .tools = {.threads = 2}, .scene = world->scene, .context = world->context};
    own.seed = seed;
    assert_done(kernel_choose(NULL, &setup.tools.kernel, &err));
    GazeGoal goal = {vec3(0, 0, 0), vec3(0, 0, -2), 0.01, most};
    return gaze_read(&setup, &goal, world->arena);
}

/* One path in some thousands meets the lamp. Most pilots meet it once or never; intervals hold
 * the truth all the same, of few paths and of more; a standard deviation of 100 is 2.2 %. */
TEST(intervals_hold_what_few_paths_find) {
    double wanted;
    SCOPED_WORLD world = rare_world(&wanted);
    world_ready(&world, 16);
    for (int most = 2048; most <= 16384; most *= 8) {
        int held = 0;
        for (uint32_t run = 0; run < RARE_RUNS; run++) {
            MeanInterval in = read_seed(&world, most, run).mirrored.interval;
            held += in.low <= wanted && wanted <= in.high;
        }
        if (held < 0.93 * RARE_RUNS)
            fail_msg("%d paths: %d of %d hold %g", most, held, RARE_RUNS, wanted);
    }
}

/* ---- what a camera sees there ------------------------------------------------------------ */

#define CAMERA_PATHS 60000

static double camera_luminance(const World *world, double *sigma) {
    PathStatistics statistics = {0};
    double sum = 0, squares = 0, narrow = 1 - cos(radians_from_degrees(GAZE_CONE_DEG));
    for (uint32_t i = 0; i < CAMERA_PATHS; i++) {
        Wavelengths w;
        PathResult seen;
        Sampler sampler = sampler_start(7, 0, 0, i);
        Vec2 place = sampler_2d(&sampler);
        wavelengths_sample(sampler_1d(&sampler), &w);
        double cosine = 1 - narrow * (double)place.x, sine = sqrt(1 - cosine * cosine);
        double phi = 2 * PI * (double)place.y;
        Vec3 d = vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)-cosine);
        PathStart start = {.context = &world->context,
                           .wavelengths = &w,
                           .sampler = &sampler,
                           .statistics = &statistics};
        path_from_ray(&start, (Ray){vec3(0, 0, 0), d, 0, INFINITY}, &seen);
        sum += (double)seen.xyz[1];
        squares += (double)seen.xyz[1] * (double)seen.xyz[1];
    }
    double mean = sum / CAMERA_PATHS;
    *sigma = sqrt((squares / CAMERA_PATHS - mean * mean) / CAMERA_PATHS);
    return mean;
}

TEST(both_add_up_to_what_a_camera_sees) {
    SCOPED_WORLD world = sunny_world();
    add_dashboard(&world);
    builder_sky(world.scene, 2000);
    add_pane(&world, 60);
    add_pane(&world, 62);
    GazeReading found = read_gaze(&world);
    double sigma, wanted = camera_luminance(&world, &sigma);
    double sum = found.through.mean + found.mirrored.mean;
    double sure = 3 * hypot(sigma, hypot(found.through.sigma, found.mirrored.sigma));
    if (!(fabs(sum - wanted) < sure && sure < 0.02 * wanted))
        fail_msg("%g + %g, a camera sees %g +- %g", found.through.mean, found.mirrored.mean, wanted,
                 sigma);
    assert_true(found.through.mean > 0 && found.mirrored.mean > 0);
}

TEST_PROGRAM(NULL, NULL)
