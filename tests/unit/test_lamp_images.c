/* SPDX-License-Identifier: Apache-2.0 */
/* Images of lamps in mirrors, however small, against plane geometry. */
#include "fixture.h"

#include "base/units.h"
#include "review/eye/lamp_images.h"
#include "world_fixture.h"

#define LAMP_CD_M2 1e6f
#define MIRROR_M 1.0 /* from the eye, across the gaze */
#define LAMP_M 2.0   /* on from the mirror, behind the eye */
#define PIXELS 200

static const ReviewRequest request = {.forward = {0, 0, -1}};
static const GlareHead     head = {.right = {1, 0, 0}, .up = {0, 1, 0}, .gaze = {0, 0, -1}};

/* world_ready comes before. */
static LampImages find_by(World *world, int threads, double least_cd_m2)
{
    const Kernel *kernel;
    assert_done(kernel_choose(NULL, &kernel, &err));
    Setup       setup = {.request = &request, .tools = {.kernel = kernel, .threads = threads},
                         .scene = world->scene, .context = world->context};
    BrightLamps lamps = bright_lamps(world->scene, least_cd_m2, &world->arena);
    LampImagesArgs args = {&setup, &head, &lamps, PIXELS, 7};
    return lamp_images_find(&args, &world->arena);
}

static LampImages find(World *world)
{
    world_ready(world, 16);
    return find_by(world, 2, 2000);
}

typedef struct ImageSums {
    double sr, cd_m2; /* the mean over it */
    Vec3   middle;
} ImageSums;

static ImageSums sums_of(const LampImages *images)
{
    ImageSums sums = {0};
    for (int i = 0; i < images->count; i++) {
        const LampImage *image = &images->list[i];
        sums.sr += image->sr;
        sums.cd_m2 += image->sr * image->cd_m2;
        sums.middle = vec3_add(sums.middle, vec3_scale(image->towards, (float)image->sr));
    }
    if (sums.sr > 0) sums.cd_m2 /= sums.sr;
    if (sums.sr > 0) sums.middle = vec3_normalize(sums.middle);
    return sums;
}

/* A square lamp, by its middle, that faces -Z; half its side, m. */
static void add_lamp(World *world, Vec3 middle, double half)
{
    builder_part(world->scene, builder_lamp(LAMP_CD_M2));
    builder_quad(world->scene, middle, vec3((float)-half, 0, 0), vec3(0, (float)half, 0));
}

#define FAR (MIRROR_M + LAMP_M)

/* Behind the eye and above it, so many degrees wide as a mirror across the gaze shows it. */
static double add_behind(World *world, double degrees, double up)
{
    double half = FAR * tan(radians_from_degrees(degrees / 2));
    add_lamp(world, vec3(0, (float)up, (float)(LAMP_M - MIRROR_M)), half);
    return half;
}

static void add_across(World *world, Material material, double half)
{
    builder_part(world->scene, material);
    builder_quad(world->scene, vec3(0, 0, (float)-MIRROR_M), vec3((float)half, 0, 0),
                 vec3(0, (float)half, 0));
}

/* far: of the image, m along the gaze, `up` above it. share: of the lamp's luminance. */
static void assert_shown(const LampImages *images, double half, double up, double far,
                         double share)
{
    ImageSums sums = sums_of(images);
    double cosine = far / hypot(far, up);
    double sr = 4 * half * half / (far * far) * cosine * cosine * cosine;
    double degrees = degrees_from_radians(2 * atan(half / far));
    if (!(fabs(sums.sr / sr - 1) < 0.05))
        fail_msg("%g degrees: %g sr, required %g", degrees, sums.sr, sr);
    double found = sums.cd_m2 / (double)LAMP_CD_M2;
    if (!(fabs(found - share) < 0.01 * share))
        fail_msg("%g degrees: %g of the lamp, required %g", degrees, found, share);
    double apart = hypot((double)sums.middle.y - up / hypot(far, up), (double)sums.middle.x);
    if (!(apart < 0.1 * half / far)) fail_msg("%g degrees: %g away", degrees, apart);
}

TEST(a_mirror_shows_a_lamp_of_any_size)
{
    static const double widths[] = {0.003, 0.02, 0.1, 0.5, 2, 8};
    for (int i = 0; i < 6; i++) {
        SCOPED_WORLD world = world_start();
        double half = add_behind(&world, widths[i], 0.3);
        add_across(&world, builder_mirror(1), 1);
        LampImages images = find(&world);
        assert_shown(&images, half, 0.3, FAR, 1);
    }
}

/* Chance has no part in it: of paths that meet lacquer a twenty-fifth are mirrored. */
TEST(lacquer_and_a_pane_mirror_by_fresnel)
{
    Material lacquer = builder_material(0.5f);
    lacquer.roughness = 0;
    lacquer.specular = 1;
    lacquer.ior = 1.5f;
    for (int is_pane = 0; is_pane < 2; is_pane++) {
        SCOPED_WORLD world = world_start();
        double half = add_behind(&world, 0.05, 0.1), r = 0.04;
        add_across(&world, is_pane ? builder_pane(1.5f) : lacquer, 1);
        LampImages images = find(&world);
        assert_shown(&images, half, 0.1, FAR, is_pane ? 2 * r / (1 + r) : r);
    }
}

/* Up by the first, 1 m ahead, and back over the eye by the second, 1 m above it. */
TEST(what_one_mirror_shows_in_another_is_found)
{
    SCOPED_WORLD world = world_start();
    add_lamp(&world, vec3(0, 1, 1), 0.002);
    builder_part(world.scene, builder_mirror(1));
    builder_quad(world.scene, vec3(0, 0, -1), vec3(0.2f, 0, 0), vec3(0, 0.15f, -0.15f));
    builder_part(world.scene, builder_mirror(1));
    builder_quad(world.scene, vec3(0, 1, -1), vec3(0.2f, 0, 0), vec3(0, 0.15f, 0.15f));
    LampImages images = find(&world);
    assert_shown(&images, 0.002, 0, 4, 1);
}

/* So much of it as the mirror covers. */
TEST(a_small_mirror_shows_a_part_of_a_large_lamp)
{
    SCOPED_WORLD world = world_start();
    add_behind(&world, 8, 0);
    add_across(&world, builder_mirror(1), 0.02);
    LampImages images = find(&world);
    ImageSums sums = sums_of(&images);
    double sr = 4 * 0.02 * 0.02 / (MIRROR_M * MIRROR_M);
    if (!(fabs(sums.sr / sr - 1) < 0.05)) fail_msg("%g sr, required %g", sums.sr, sr);
}

TEST(what_hides_a_lamp_hides_its_image)
{
    SCOPED_WORLD world = world_start();
    add_behind(&world, 0.1, 0.3);
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0.25f, 0.8f), vec3(-0.1f, 0, 0), vec3(0, 0.1f, 0));
    add_across(&world, builder_mirror(1), 1);
    assert_int_equal(find(&world).count, 0);
}

TEST(a_lamp_that_is_too_dim_is_no_source)
{
    SCOPED_WORLD world = world_start();
    add_behind(&world, 1, 0.3);
    add_across(&world, builder_mirror(1), 1);
    world_ready(&world, 16);
    assert_int_equal(find_by(&world, 1, 2 * (double)LAMP_CD_M2).count, 0);
}

TEST(threads_change_nothing)
{
    SCOPED_WORLD world = world_start();
    add_behind(&world, 0.05, 0.3);
    add_across(&world, builder_mirror(1), 1);
    world_ready(&world, 16);
    LampImages one = find_by(&world, 1, 2000), many = find_by(&world, 5, 2000);
    assert_int_equal(one.count, many.count);
    for (int i = 0; i < one.count; i++) {
        const LampImage *a = &one.list[i], *b = &many.list[i];
        assert_true(a->cd_m2 == b->cd_m2 && a->sr == b->sr && a->x == b->x && a->y == b->y);
    }
}

TEST_PROGRAM(NULL, NULL)
