/* SPDX-License-Identifier: Apache-2.0 */
/* Solids of glass with a thin film, or brushed, in a scene: nobody sees them in a furnace,
 * light samples and chance find the same light, and a brushed face blurs along its brushing. */

#include "world_fixture.h"

enum { BOUNCES = 40 };

static Material glass(float ior, float roughness) {
    Material material = builder_material(1);
    material.transmission = 1;
    material.is_solid = true;
    material.ior = ior;
    material.roughness = roughness;
    return material;
}

static MaterialFilm *film_of(World *world, float share, float ior, float nm) {
    MaterialFilm *film = ARENA_NEW(&world->arena, MaterialFilm, 1);
    TextureSlot none = builder_no_texture();
    *film = (MaterialFilm){.share = share,
                           .ior = ior,
                           .least_nm = nm,
                           .most_nm = nm,
                           .texture = none,
                           .thickness_texture = none};
    return film;
}

/* Luminance of a narrow cone. */
static WorldMean look(const World *world, Vec3 from, Vec3 to, int count) {
    return world_luminance(world, &(WorldLook){from, vec3_sub(to, from), 0.1f, 3, count});
}

/* A closed ball, also one that parts light. */
TEST(a_filmed_ball_is_not_seen_in_a_furnace) {
    static const float balls[][4] = {/* ior, share, film's ior, nm */
                                     {1.5f, 1, 1.8f, 400},
                                     {1.33f, 0.5f, 1.33f, 900},
                                     {1, 1, 1.33f, 350},
                                     {2.4f, 1, 1.3f, 120}};
    for (int i = 0; i < 8; i++) {
        SCOPED_WORLD world = world_start();
        Material ball = glass(balls[i / 2][0], 0);
        Curve *index = ARENA_NEW(&world.arena, Curve, 1);
        for (int k = 0; k < CURVE_COUNT; k++)
            index->value[k] = fmaxf(balls[i / 2][0] + 0.05f - 2e-4f * (float)k, 1);
        ball.film = film_of(&world, balls[i / 2][1], balls[i / 2][2], balls[i / 2][3]);
        if (i % 2) ball.index = index;
        builder_part(world.scene, ball);
        builder_sphere(world.scene, vec3(0, 0, 0), 1, 48, 0);
        builder_sky(world.scene, 1000);
        world_ready(&world, BOUNCES);
        WorldMean seen =
            look(&world, vec3(0.5f, 0.3f, 3), vec3(0.5f, 0.3f, 0), i % 2 ? 200000 : 40000);
        if (!(fabs(seen.mean - 1000) < 3.5 * seen.sigma + 0.5 && seen.sigma < 2))
            fail_msg("ball %d: %g +- %g", i, seen.mean, seen.sigma);
    }
}

/* ---- rough ------------------------------------------------------------------------------ */

/* A box whose top is at y = 0. Its tangents lie along x where they can, else along z. */
static void add_box(World *world, Material material) {
    static const Vec3 sides[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                  {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    Scene *scene = world->scene;
    Tangent *tangents = ARENA_NEW(&world->arena, Tangent, BUILDER_VERTICES);
    builder_part(scene, material);
    scene->parts[scene->part_count - 1].tangents = tangents;
    for (int i = 0; i < 6; i++) {
        Vec3 n = sides[i], u = n.x != 0 ? vec3(0, 0, 1) : vec3(1, 0, 0), v = vec3_cross(n, u);
        Vec3 size = vec3(2, 0.3f, 2),
             centre = vec3(n.x * size.x, n.y * size.y - 0.3f, n.z * size.z);
        for (int k = 0; k < 4; k++) tangents[scene->vertex_count + (uint32_t)k] = (Tangent){u, 1};
        builder_quad(scene, centre, vec3(u.x * size.x, 0, u.z * size.z),
                     vec3(v.x * size.x, v.y * size.y, v.z * size.z));
    }
}

static Brushing *brushing_of(World *world, float turn) {
    Brushing *brushing = ARENA_NEW(&world->arena, Brushing, 1);
    *brushing = (Brushing){.strength = 0.7f,
                           .cosine = cosf(turn),
                           .sine = sinf(turn),
                           .texture = builder_no_texture()};
    return brushing;
}

/* Also one whose brushing alone is rough, and one without tangents, which is not brushed. */
TEST(a_brushed_box_is_not_seen_in_a_furnace) {
    static const float roughness[] = {0.3f, 0.6f, 0, 0.5f};
    for (int i = 0; i < 4; i++) {
        SCOPED_WORLD world = world_start();
        Material box = glass(1.5f, roughness[i]);
        box.brushing = brushing_of(&world, 0.4f);
        if (i == 1) box.film = film_of(&world, 0.8f, 1.9f, 450);
        add_box(&world, box);
        if (i == 3) world.scene->parts[world.scene->part_count - 1].tangents = NULL;
        builder_sky(world.scene, 1000);
        world_ready(&world, 1000);
        WorldMean seen = look(&world, vec3(0, 1, 1.5f), vec3(0, 0, 0), 60000);
        if (!(fabs(seen.mean - 1000) < 3.5 * seen.sigma + 2 && seen.sigma < 4))
            fail_msg("box %d: %g +- %g", i, seen.mean, seen.sigma);
    }
}

/* A lamp above, a lamp below, a sky. */
static World box_world(bool has_film, bool is_brushed) {
    World world = world_start();
    Material box = glass(1.5f, 0.6f);
    if (has_film) box.film = film_of(&world, 0.8f, 1.9f, 450);
    if (is_brushed) box.brushing = brushing_of(&world, 0.4f);
    builder_part(world.scene, builder_lamp(500));
    builder_quad(world.scene, vec3(0.3f, 1.5f, -1), vec3(1, 0, 0), vec3(0, 0, 1));
    builder_quad(world.scene, vec3(0, -1.2f, 0.2f), vec3(1, 0, 0), vec3(0, 0, -1));
    add_box(&world, box);
    builder_sky(world.scene, 40);
    world_ready(&world, 6);
    return world;
}

TEST(every_strategy_finds_the_same_light) {
    for (int i = 1; i < 4; i++) {
        SCOPED_WORLD world = box_world(i & 1, i & 2);
        WorldMean found[3];
        for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
            world.context.strategy = s;
            found[s] = look(&world, vec3(0, 1, 1.5f), vec3(0, 0, 0), 150000);
        }
        for (int s = 1; s < 3; s++)
            if (!(fabs(found[s].mean - found[0].mean) <
                      3.5 * hypot(found[s].sigma, found[0].sigma) &&
                  found[s].sigma < 0.02 * found[s].mean))
                fail_msg("film %d, brushed %d, strategy %d: %g +- %g, both %g +- %g", i & 1, i >> 1,
                         s, found[s].mean, found[s].sigma, found[0].mean, found[0].sigma);
    }
}

/* A small lamp aside of the mirror's way is seen by facets that lean to it. */
static double aside(Vec3 lamp, float turn) {
    SCOPED_WORLD world = world_start();
    Material box = glass(1.5f, 0.3f);
    box.brushing = brushing_of(&world, turn);
    builder_part(world.scene, builder_lamp(1e4f));
    builder_quad(world.scene, lamp, vec3(0.2f, 0, 0), vec3(0, 0, 0.2f));
    add_box(&world, box);
    world_ready(&world, 1);
    double seen = look(&world, vec3(0, 1, 0), vec3(0, 0, 0), 20000).mean;
    return seen;
}

TEST(a_brushed_face_blurs_along_its_brushing) {
    Vec3 along_x = vec3(1, 1, 0), along_z = vec3(0, 1, 1);
    double with_x = aside(along_x, 0), across_x = aside(along_z, 0);
    double with_z = aside(along_z, 0.5f * 3.14159265f), across_z = aside(along_x, 1.57079633f);
    assert_true(with_x > 20 * across_x);
    assert_close(with_x, with_z, 0.02);
    assert_close(across_x, across_z, 0.02);
}

TEST_PROGRAM(NULL, NULL)
