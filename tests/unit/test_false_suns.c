/* SPDX-License-Identifier: Apache-2.0 */
/* Where the sun has to stand for a mirror to throw it into an eye, against plane geometry. */
#include "fixture.h"

#include "base/units.h"
#include "review/eye/false_suns.h"
#include "world_fixture.h"

static const ReviewRequest request = {.forward = {0, 0, -1}};
static const double radius = SUN_MEAN_RADIUS_DEG;

typedef struct Found {
    World world;
    FalseSuns suns;
} Found;

static Setup setup_of(const World *world) {
    const Kernel *kernel;
    assert_done(kernel_choose(NULL, &kernel, &err));
    return (Setup){.request = &request,
                   .tools = {.kernel = kernel, .threads = 2},
                   .scene = world->scene,
                   .context = world->context};
}

/* Under suns that have [from, end) of the bands alone, evenly. */
static FalseSuns under(const FalseSunRays *rays, int from, int end, Arena *arena) {
    float bands[LIGHT_BANDS];
    for (int b = 0; b < LIGHT_BANDS; b++) bands[b] = b >= from && b < end ? 2 : 0;
    return false_suns_of(rays, bands, arena);
}

static void search(Found *found) {
    FalseSunRays rays;
    Arena *arena = &found->world.arena;
    world_ready(&found->world, 16);
    Setup setup = setup_of(&found->world);
    false_suns_search(&setup, vec3(0, 0, 0), arena, &rays);
    found->suns = under(&rays, 0, LIGHT_BANDS, arena);
}

/* A mirror 1 m ahead of the eye, below the line of sight by `below` degrees, whose normal
 * halves the way to a sun at elevation `sun` behind it; sides in degrees as the eye sees
 * them. */
static void add_facet(World *world, double below, double sun, double wide, double high) {
    double b = radians_from_degrees(below), s = radians_from_degrees(sun);
    Vec3 at = vec3(0, (float)-sin(b), (float)-cos(b));
    Vec3 towards = vec3(0, (float)sin(s), (float)cos(s));
    Vec3 normal = vec3_normalize(vec3_sub(towards, at));
    Vec3 right = vec3(1, 0, 0), up = vec3_cross(normal, right);
    float slant = -vec3_dot(at, normal);
    builder_part(world->scene, builder_mirror(1));
    builder_quad(world->scene, at, vec3_scale(right, (float)tan(radians_from_degrees(wide / 2))),
                 vec3_scale(up, (float)tan(radians_from_degrees(high / 2)) / slant));
}

static Vec3 sun_at(double elevation, double aside) {
    double e = radians_from_degrees(elevation), a = radians_from_degrees(aside);
    return vec3((float)(cos(e) * sin(a)), (float)sin(e), (float)(cos(e) * cos(a)));
}

/* Columns of the table meet there: a disc about the zenith, or beside it, is whole. */
static void assert_whole_about_zenith(const FalseSuns *suns) {
    for (double away = 0; away < 0.6; away += 0.05)
        for (int aside = 0; aside < 360; aside += 45) {
            double share = false_suns_at(suns, sun_at(90 - away, aside)).share;
            if (!(fabs(share - 1) < 0.03))
                fail_msg("%g away, %d aside: share %g, required: 1", away, aside, share);
        }
}

/* A wide flat mirror shows all of the sun: its whole illuminance, less what silver takes. */
TEST(a_wide_mirror_shows_the_whole_sun) {
    Found found = {.world = world_start()};
    add_facet(&found.world, 20, 35, 8, 8);
    add_facet(&found.world, 45, 90, 8, 8);
    search(&found);
    assert_whole_about_zenith(&found.suns);
    for (int i = -2; i <= 2; i++) {
        FalseSunSight sight = false_suns_at(&found.suns, sun_at(35 + i, i));
        if (!(fabs(sight.share - 1) < 0.03))
            fail_msg("%d: share %g, required: "
                     "1",
                     i, sight.share);
        assert_int_equal(sight.part_id, 0);
        /* The higher the sun, the higher its image stands. */
        double wanted = -sin(radians_from_degrees(20 - i));
        if (!(fabs((double)sight.seen.y - wanted) < 0.002))
            fail_msg("%d: seen at %g, required: %g", i, (double)sight.seen.y, wanted);
    }
    assert_true(false_suns_at(&found.suns, sun_at(35 + 5, 0)).share == 0);
    assert_true(false_suns_at(&found.suns, sun_at(-35, 0)).share == 0);
    world_end(&found.world);
}

static double all_sr(const FalseSuns *suns, int part_id) {
    double sum = 0;
    for (int i = 0; i < suns->count; i++)
        if (suns->list[i].part_id == part_id) sum += (double)suns->list[i].sr;
    return sum;
}

/* What is found is kept by scene and eye, and is the same by any number of threads. */
static const FalseSunRays *ask_twice(SunSearches *kept, const World *world) {
    Vec3 eye = vec3(0, 0, 0);
    Setup setup = setup_of(world), other = setup;
    setup.identity = "a scene";
    other.identity = "another";
    other.tools.threads = 1;
    const FalseSunRays *rays = sun_searches_find(kept, &setup, eye);
    const FalseSunRays *again = sun_searches_find(kept, &other, eye);
    assert_true(rays != again && rays->count == again->count && rays->count > 0);
    assert_memory_equal(rays->list, again->list, (size_t)rays->count * sizeof *rays->list);
    assert_ptr_equal(sun_searches_find(kept, &setup, eye), rays);
    assert_ptr_equal(sun_searches_find(kept, &other, eye), again);
    return rays;
}

/* Light keeps its radiance: over all suns the shares add up to the facet's own solid angle. A
 * sun of two colours gets from a blue mirror what either gets. */
TEST(all_suns_together_see_the_facets_solid_angle) {
    SCOPED_WORLD world = world_start();
    SunSearches kept = sun_searches_start();
    double wide = radians_from_degrees(3), high = radians_from_degrees(1);
    add_facet(&world, 10, 50, 3, 1);
    add_facet(&world, 40, 50, 3, 1);
    world.scene->materials[1].base_color[0] = 0.3f;
    for (int c = 1; c < 3; c++) world.scene->materials[1].base_color[c] = 1;
    world_ready(&world, 16);
    const FalseSunRays *rays = ask_twice(&kept, &world);
    FalseSuns white = under(rays, 0, LIGHT_BANDS, &world.arena);
    FalseSuns blue = under(rays, 0, LIGHT_BANDS / 2, &world.arena);
    FalseSuns red = under(rays, LIGHT_BANDS / 2, LIGHT_BANDS, &world.arena);
    double sum = all_sr(&white, 0), by_blue = all_sr(&blue, 1), by_red = all_sr(&red, 1);
    if (!(fabs(sum / (wide * high) - 1) < 0.03)) fail_msg("%g of %g sr", sum, wide * high);
    assert_close(by_blue + by_red, 2 * all_sr(&white, 1), 1e-6);
    if (!(by_red < 0.8 * by_blue)) fail_msg("%g of red, %g of blue light", by_red, by_blue);
    sun_searches_end(&kept);
}

/* A facet of 0.4 degrees, which the sun crosses in minutes: it lights the eye from no more than
 * the facet's size and the sun's away, and by the part of the disc that the facet covers. */
TEST(a_small_facet_is_found_where_it_stands) {
    Found found = {.world = world_start()};
    double side = 0.4, covered = side * side / (PI * radius * radius);
    add_facet(&found.world, 25, 30, side, side);
    search(&found);
    FalseSunSight sight = false_suns_at(&found.suns, sun_at(30, 0));
    if (!(fabs(sight.share / covered - 1) < 0.15)) /* of sixteen rays */
        fail_msg("share %g, required: %g", sight.share, covered);
    double reach = radius + side * sqrt(0.5) + 0.05;
    for (double away = -2; away <= 2; away += 0.05) {
        double share = false_suns_at(&found.suns, sun_at(30 + away, 0)).share;
        if (fabs(away) > reach && share > 0) fail_msg("%g degrees away: %g", away, share);
        if (fabs(away) < side / 2 && !(share > 0)) fail_msg("%g degrees away: none", away);
    }
    world_end(&found.world);
}

/* Rough walls have no image, and what stands before the sun hides it. */
TEST(walls_have_no_image_and_hide_the_sun) {
    Found open = {.world = world_start()}, closed = {.world = world_start()};
    builder_part(open.world.scene, builder_material(0.8f));
    builder_quad(open.world.scene, vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, 1, 0));
    search(&open);
    assert_int_equal(open.suns.count, 0);
    add_facet(&closed.world, 20, 35, 8, 8);
    builder_part(closed.world.scene, builder_material(0.8f));
    builder_quad(closed.world.scene, vec3(0, 3, 4), vec3(5, 0, 0), vec3(0, 5, 0));
    search(&closed);
    assert_int_equal(closed.suns.count, 0);
    world_end(&open.world);
    world_end(&closed.world);
}

/* A thin pane in front takes its share of the light on the way to the sun, and throws an image
 * of its own: by Fresnel's equations of both faces. */
TEST(a_pane_throws_what_its_faces_reflect) {
    Found found = {.world = world_start()};
    Material pane = builder_material(1);
    double face = 0.04, both = 2 * face / (1 + face); /* at normal incidence, n = 1.5 */
    pane.specular = 1;
    pane.roughness = 0;
    pane.transmission = 1;
    builder_part(found.world.scene, pane);
    builder_quad(found.world.scene, vec3(0, 0, -1), vec3(0.1f, 0, 0), vec3(0, 0.1f, 0));
    search(&found);
    FalseSunSight sight = false_suns_at(&found.suns, sun_at(0.5, 0));
    if (!(fabs(sight.share / both - 1) < 0.1)) fail_msg("%g, required: %g", sight.share, both);
    world_end(&found.world);
}

TEST_PROGRAM(NULL, NULL)
