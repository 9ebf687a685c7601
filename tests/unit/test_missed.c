/* SPDX-License-Identifier: Apache-2.0 */
/* Light that no connection makes: how much of it lands, and whose it is. */
#include "missed/missed.h"
#include "world_fixture.h"

/* ---- where a picture shows a place ------------------------------------------------------- */

static const Camera CAMERAS[] = {
    {.is_perspective = true, .half_width = 0.8f, .half_height = 0.5f, .width = 80, .height = 50},
    {.half_width = 0.3f, .half_height = 0.2f, .width = 30, .height = 20},
    {.is_perspective = true,
     .fisheye = FISHEYE_EQUIDISTANT,
     .half_width = 1,
     .half_height = 1,
     .width = 64,
     .height = 64},
    {.is_perspective = true,
     .fisheye = FISHEYE_EQUISOLID,
     .half_width = 1.5f,
     .half_height = 1,
     .width = 96,
     .height = 64},
};
enum { CAMERA_COUNT = sizeof CAMERAS / sizeof *CAMERAS };

static Camera placed(int i) {
    Camera camera = CAMERAS[i];
    Frame frame = frame_from_z(vec3_normalize(vec3(0.3f, -0.5f, 0.7f)));
    camera.world_from_camera = (Transform){frame.x, frame.y, frame.z, vec3(1, 2, -3)};
    return camera;
}

TEST(a_place_stands_where_the_camera_s_ray_meets_it) {
    for (int i = 0; i < CAMERA_COUNT; i++) {
        Camera camera = placed(i);
        for (int k = 0; k < 100; k++) {
            float x = (float)(k % 10) / 10 + 0.05f, y = (float)(k / 10) / 10 + 0.05f;
            EyePlace place;
            if (!camera_sees(&camera, x * (float)camera.width, y * (float)camera.height)) continue;
            Ray ray = camera_ray(&camera, x * (float)camera.width, y * (float)camera.height);
            assert_true(eye_place_of(&camera, vec3_along(ray.origin, ray.direction, 2.5f), &place));
            assert_near((double)place.x, (double)x, 1e-4);
            assert_near((double)place.y, (double)y, 1e-4);
            assert_near((double)vec3_dot(place.ray.direction, ray.direction), -1, 1e-5);
        }
    }
}

/* A surface of luminance L, at a right angle to every ray, a distance r off: each solid angle dw
 * of it sends out f lm = L r^2 dw, and all of them make the picture's mean: L, in the circle of a
 * fisheye. */
TEST(an_even_surface_has_its_luminance_in_the_picture) {
    enum { STEPS = 400 };
    for (int i = 0; i < CAMERA_COUNT; i++) {
        Camera camera = placed(i);
        double sum = 0, r = 1.7;
        if (!camera.is_perspective) continue;
        for (int k = 0; k < STEPS * STEPS; k++) {
            float u = ((float)(k % STEPS) + 0.5f) / STEPS, v = ((float)(k / STEPS) + 0.5f) / STEPS;
            float sine, cosine, z = 1 - 2 * u;
            EyePlace place;
            sincos_turns(v, &sine, &cosine);
            Vec3 d = vec3(sqrtf(1 - z * z) * cosine, sqrtf(1 - z * z) * sine, z);
            Vec3 at = vec3_along(camera.world_from_camera.origin, d, (float)r);
            if (eye_place_of(&camera, at, &place))
                sum += (double)place.per_flux * r * r * 4 * PI / (STEPS * STEPS);
        }
        double area = 4 * (double)camera.half_width * (double)camera.half_height;
        assert_near(sum, camera.fisheye ? PI / area : 1, 5e-3);
    }
}

/* ---- a periscope ------------------------------------------------------------------------- */

#define CANDELA 700.0f
#define RHO 0.8f
#define WHITE 0.6f
#define LOW 0.1f /* half of the mirror's side that the lamp meets */

static void square(Scene *scene, Vec3 centre, Vec3 n, float half) {
    Vec3 v = vec3(0, 0, half), u = vec3_scale(vec3_normalize(vec3_cross(v, n)), half);
    builder_quad(scene, centre, u, v);
}

/* Two mirrors at 45 degrees, and a white wall at x = -1 that faces +x. */
static void build_periscope(World *world) {
    Scene *scene = world->scene;
    builder_part(scene, builder_mirror(RHO));
    square(scene, vec3(1, 0, 0), vec3_normalize(vec3(-1, 1, 0)), LOW);
    builder_part(scene, builder_mirror(RHO));
    square(scene, vec3(1, 1, 0), vec3_normalize(vec3(-1, -1, 0)), 0.25f);
    Material wall = builder_material(WHITE);
    wall.specular = 0;
    builder_part(scene, wall);
    square(scene, vec3(-1, 1, 0), vec3(1, 0, 0), 1);
}

static void add_lamp(World *world) {
    world->scene->lights[world->scene->light_count++] = (PunctualLight){
        .name = "lamp", .kind = LIGHT_POINT, .intensity = {CANDELA, CANDELA, CANDELA}};
}

/* Sees the wall straight, 0.9 m by 0.9 m. */
#define HALF 0.45f
static const Camera WALL = {.world_from_camera = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {-0.2f, 1, 0}},
                            .half_width = HALF,
                            .half_height = HALF,
                            .width = 64,
                            .height = 64};
static const MissedEye EYE = {"wall", &WALL, NO_ID};

/* Of the low mirror, from the lamp. */
static double low_sr(void) {
    enum { STEPS = 64 };
    double sum = 0, step = 2 * (double)LOW / STEPS;
    for (int i = 0; i < STEPS * STEPS; i++) {
        double a = (i % STEPS + 0.5) * step - (double)LOW,
               b = (i / STEPS + 0.5) * step - (double)LOW;
        double x = 1 + a * sqrt(0.5), y = a * sqrt(0.5), d2 = x * x + y * y + b * b;
        sum += step * step * (x - y) * sqrt(0.5) / (d2 * sqrt(d2));
    }
    return sum;
}

TEST(what_two_mirrors_land_is_the_lamp_s_intensity_in_their_solid_angle) {
    SCOPED_WORLD world = world_start();
    build_periscope(&world);
    add_lamp(&world);
    world_ready(&world, 16);
    MissedLight missed = missed_light_find(&world.context, &EYE, 1, &world.arena);
    assert_int_equal(missed.count, 1);
    const MissedPair *pair = &missed.pairs[0];
    assert_int_equal(pair->way.from, CHAIN_LAMP);
    assert_int_equal(pair->way.part_id, 0);
    assert_int_equal(pair->way.then_id, 1);
    assert_false(pair->way.is_solid);
    double lm = (double)CANDELA * (double)RHO * (double)RHO * low_sr();
    assert_near(pair->light * 4 * (double)(HALF * HALF) * PI / (double)WHITE, lm, 0.02 * lm);
    assert_near(missed.all.light, pair->light, 1e-9);
    Arena scratch = world.arena;
    assert_non_null(missed_words(world.scene, &missed, &scratch));
}

TEST(ways_of_more_bounces_than_the_paths_are_not_missed) {
    SCOPED_WORLD world = world_start();
    build_periscope(&world);
    add_lamp(&world);
    world_ready(&world, 2);
    assert_int_equal(missed_light_find(&world.context, &EYE, 1, &world.arena).count, 0);
    world.context.max_bounces = 3;
    assert_int_equal(missed_light_find(&world.context, &EYE, 1, &world.arena).count, 1);
}

/* The same square in place of the lamp: chance finds a large one. */
TEST(only_an_emitter_that_is_hardly_found_is_missed) {
    const float halves[] = {0.01f, 0.4f};
    for (int i = 0; i < 2; i++) {
        SCOPED_WORLD world = world_start();
        build_periscope(&world);
        builder_part(world.scene, builder_lamp(1e6f));
        square(world.scene, vec3(-0.1f, 0, 0), vec3(1, 0, 0), halves[i]);
        world_ready(&world, 16);
        MissedLight missed = missed_light_find(&world.context, &EYE, 1, &world.arena);
        assert_int_equal(missed.count > 0, i == 0);
        if (i == 0) assert_int_equal(missed.pairs[0].way.from, CHAIN_EMITTER);
    }
}

/* ---- solids ------------------------------------------------------------------------------ */

/* A slab between the lamp and the wall, its far face turned about z. */
static void build_slab(Scene *scene, float lean) {
    Material glass = builder_pane(1.5f);
    glass.is_solid = true;
    glass.lets_light_through = false;
    glass.attenuation_distance_m = INFINITY;
    builder_part(scene, glass);
    Vec3 near[4], far[4];
    for (int i = 0; i < 4; i++) {
        float y = i == 1 || i == 2 ? 1.5f : 0.5f, z = i < 2 ? -0.5f : 0.5f;
        near[i] = vec3(0.3f, y, z);
        far[i] = vec3(0.1f + lean * (y - 1), y, z);
    }
    for (int i = 0; i < 6; i++) {
        static const int sides[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
        Vec3 c[4];
        for (int k = 0; k < 4; k++) c[k] = i == 0 ? near[k] : far[3 - k];
        if (i > 1) {
            const int *s = sides[i - 2];
            c[0] = near[s[1]], c[1] = near[s[0]], c[2] = far[s[0]], c[3] = far[s[1]];
        }
        Vec3 n = vec3_normalize(vec3_cross(vec3_sub(c[1], c[0]), vec3_sub(c[2], c[0])));
        uint32_t v[4];
        for (int k = 0; k < 4; k++) v[k] = builder_vertex(scene, c[k], n, 0, 0);
        builder_triangle(scene, v[0], v[1], v[2]);
        builder_triangle(scene, v[0], v[2], v[3]);
    }
}

TEST(a_wedge_s_light_is_missed_a_plate_s_is_connected) {
    for (int i = 0; i < 2; i++) {
        SCOPED_WORLD world = world_start();
        builder_part(world.scene, builder_material(WHITE));
        square(world.scene, vec3(-1, 1, 0), vec3(1, 0, 0), 0.2f);
        add_lamp(&world);
        world.scene->lights[0].position = vec3(0.5f, 1, 0);
        build_slab(world.scene, i ? 0.2f : 0);
        world_ready(&world, 16);
        MissedLight missed = missed_light_find(&world.context, &EYE, 1, &world.arena);
        assert_int_equal(missed.count, i);
        if (i) assert_true(missed.pairs[0].way.is_solid);
    }
}

TEST(what_is_connected) {
    const PathContext without = {.max_bounces = 8};
    const struct {
        LightChain chain;
        bool is_connected;
    } rows[] = {{{CHAIN_SUN, 0, 0, 0, false}, true},    {{CHAIN_LAMP, 1, 0, 0, false}, true},
                {{CHAIN_LAMP, 0, 3, 0, false}, true},   {{CHAIN_LAMP, 2, 0, 0, false}, false},
                {{CHAIN_LAMP, 1, 1, 0, false}, false},  {{CHAIN_LAMP, 0, 0, 1, false}, false},
                {{CHAIN_SUN, 1, 0, 0, false}, false},   {{CHAIN_EMITTER, 1, 0, 0, false}, false},
                {{CHAIN_EMITTER, 1, 0, 0, true}, true}, {{CHAIN_EMITTER, 2, 0, 0, true}, false}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        assert_int_equal(chain_is_connected(&without, &rows[i].chain), rows[i].is_connected);
}

TEST_PROGRAM(NULL, NULL)
