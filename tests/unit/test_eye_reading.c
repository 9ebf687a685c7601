/* The veil that stray light lays over a gaze point, against its formula. */
#include "check.h"

#include "base/units.h"
#include "review/light/eye_reading.h"
#include "vision/disability_glare.h"
#include "world_fixture.h"

static const ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};
static const HumanEye      whose = {50, 0.5};
static const Vec3          at = {0, 0, -1}; /* looked at from the origin */

static EyeReading read_eye(World *world)
{
    const Kernel *kernel;
    Error         err = {0};
    assert_true(kernel_choose(NULL, &kernel, &err));
    world_ready(world, 16);
    Stage stage = {.request = &request, .tools = {kernel, 2}, .scene = world->scene,
                   .context = world->context};
    return eye_read(&stage, vec3(0, 0, 0), at, world->arena);
}

/* Above the line of sight. */
static Vec3 at_angle(double degrees)
{
    double t = radians_from_degrees(degrees);
    return vec3(0, (float)sin(t), (float)-cos(t));
}

static void assert_veil(EyeReading found, double degrees, double lux)
{
    double wanted = lux * disability_glare(degrees, whose);
    if (!(fabs(found.veil / wanted - 1) < 0.01))
        fail_msg("%g degrees: veil %g, wanted %g", degrees, found.veil, wanted);
}

/* A black world, but for what a test adds. */
static World dark_world(void)
{
    World world = world_start();
    builder_part(world.scene, builder_material(0));
    builder_quad(world.scene, vec3(0, -100, 0), vec3(1, 0, 0), vec3(0, 0, -1));
    return world;
}

TEST(a_small_source_veils_by_its_illuminance_of_the_pupil)
{
    (void)state;
    static const double angles[] = {1, 2, 5, 10, 30, 60, 85};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        World    world = dark_world();
        Material lamp = builder_material(0);
        double   half = 0.0005, t = radians_from_degrees(angles[i]);
        for (int k = 0; k < 3; k++) lamp.emissive_cd_m2[k] = 1e5f;
        lamp.is_emitter = true;
        builder_part(world.scene, lamp);
        Vec3 d = at_angle(angles[i]);
        Vec3 up = vec3(0, (float)(half * cos(t)), (float)(half * sin(t)));
        builder_quad(world.scene, d, vec3((float)half, 0, 0), up);
        if (vec3_dot(vec3_cross(vec3(1, 0, 0), up), d) > 0) fail_msg("the lamp looks away");
        assert_veil(read_eye(&world), angles[i], 1e5 * 4 * half * half * cos(t));
        world_end(&world);
    }
}

TEST(a_lamp_without_a_body_veils_alike)
{
    (void)state;
    World world = dark_world();
    world.scene->lights[world.scene->light_count++] =
        (PunctualLight){.name = "lamp", .kind = LIGHT_POINT, .position = at_angle(20),
                        .intensity = {300, 300, 300}, .level = 1};
    assert_veil(read_eye(&world), 20, 300 * cos(radians_from_degrees(20)));
    world_end(&world);
}

TEST(the_sun_veils_by_its_own_angle)
{
    (void)state;
    World world = dark_world();
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(15);
    world.scene->environment.sun_illuminance_lx = 50000;
    EyeReading found = read_eye(&world);
    double     lux = 50000 * cos(radians_from_degrees(15));
    assert_veil(found, 15, lux);
    if (!(fabs(found.vertical_lx / lux - 1) < 0.01)) fail_msg("%g lx", found.vertical_lx);
    assert_true(found.dgp > 0.45 && found.dgp <= 1);
    world_end(&world);
}

/* f L cos theta over the half space in front, by quadrature. */
TEST(a_uniform_sky_veils_by_the_integral)
{
    (void)state;
    World  world = dark_world();
    double sum = 0, step = 0.01;
    world.scene->environment.kind = ENVIRONMENT_CONSTANT;
    world.scene->environment.luminance_cd_m2 = 100;
    for (int i = 0; i < 3; i++) world.scene->environment.color[i] = 1;
    for (double d = DISABILITY_GLARE_MIN_DEG + step / 2; d < 90; d += step) {
        double t = radians_from_degrees(d);
        sum += disability_glare(d, whose) * cos(t) * sin(t) * radians_from_degrees(step) *
               2 * PI;
    }
    EyeReading found = read_eye(&world);
    if (!(fabs(found.veil / (100 * sum) - 1) < 0.01))
        fail_msg("veil %g, wanted %g", found.veil, 100 * sum);
    if (!(fabs(found.vertical_lx / (100 * PI) - 1) < 0.01))
        fail_msg("%g lx", found.vertical_lx);
    world_end(&world);
}

int main(void)
{
    return run_cases(NULL, NULL);
}
