/* SPDX-License-Identifier: Apache-2.0 */
/* Emitters that are near, many, or hidden below the horizon. */
#include "light_fixture.h"

#include "scene/point/coverage.h"
#include "light/alias.h"
#include "light/solid_angle.h"

/* ---- alias tables -------------------------------------------------------------------- */

/* Draws every number there is, once. */
static void assert_probabilities_exact(const double *weights, int count, Arena arena) {
    AliasTable table = alias_build(weights, count, &arena);
    uint32_t *drawn = ARENA_NEW(&arena, uint32_t, count);
    double sum = 0, total = 0;
    for (uint32_t k = 0; k < 1u << 24; k++) {
        float prob;
        int i = alias_sample(&table, (float)k * 0x1p-24f, &prob);
        drawn[i]++;
        assert_true(prob == table.slots[i].prob);
    }
    for (int i = 0; i < count; i++) sum += weights[i];
    for (int i = 0; i < count; i++) {
        assert_true((float)drawn[i] * 0x1p-24f == table.slots[i].prob);
        assert_near(table.slots[i].prob, weights[i] / sum, 2e-3 * weights[i] / sum + 0x1p-22);
        if (weights[i] == 0) assert_int_equal(drawn[i], 0);
        total += (double)table.slots[i].prob;
    }
    assert_near(total, 1, 1e-6);
}

ARENA_TEST(alias_tables_know_their_exact_probabilities) {
    static double weights[100000];
    uint32_t seed = 3;
    assert_probabilities_exact((double[]){7}, 1, arena);
    assert_probabilities_exact((double[]){0, 1, 0, 3, 0}, 5, arena);
    for (int i = 0; i < 100000; i++)
        weights[i] = pow((double)unit_float(seed = hash_u32(seed + 1)), 6);
    weights[77] = 1e4; /* the sun among stars */
    weights[78] = 0;
    assert_probabilities_exact(weights, 1000, arena);
    assert_probabilities_exact(weights, 100000, arena);
}

/* ---- triangles as a point sees them ------------------------------------------------------ */

/* From a cube's corner, an octant of the sphere; half a face from the cube's middle. */
TEST(solid_angles_are_those_of_the_sphere) {
    const Vec3 octant[3] = {{1, 0, 0}, {0, 2, 0}, {0, 0, 30}};
    const Vec3 face[3] = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}};
    const Vec3 small[3] = {{0, 0, 5}, {0.1f, 0, 5}, {0, 0.1f, 5}};
    const Vec3 in_plane[3] = {{1, 0, 0}, {0, 1, 0}, {2, 3, 0}};
    const Vec3 at_corner[3] = {{1, 0, 0}, {0, 0, 0}, {2, 3, 0}};
    assert_close(solid_angle_of(octant).value, PI / 2, 1e-5);
    assert_close(solid_angle_of(face).value, PI / 3, 1e-5);
    assert_close(solid_angle_of(small).value, 0.005 / 25, 1e-3);
    assert_near(solid_angle_of(in_plane).value, 0, 1e-6);
    assert_near(solid_angle_of(at_corner).value, 0, 0);
}

/* Directions to the points fall into every piece of the triangle as often as the piece is
 * large: by the solid angles of 64 x 64 smaller triangles, gathered by rows. */
TEST(points_are_uniform_in_the_solid_angle) {
    enum { SIDE = 8, CELLS = SIDE * SIDE, COUNT = 400000 };
    static const Vec3 seen[][3] = {
        {{1, 0, 0.1f}, {0, 2, 0.1f}, {-1, -1, 0.1f}}, /* nearly half of all */
        {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}},
        {{-30, -1, 0.3f}, {30, -1, 0.3f}, {0, 50, 0.3f}}, /* close before a long one */
        {{1, 0.001f, 0}, {1, 1, 2}, {1, -1, 2}},          /* seen edge on at one end */
        {{0.2f, 0, 3}, {0, 0.2f, 3}, {0, 0, 3}}};         /* small */
    uint32_t random = 4;
    for (size_t t = 0; t < sizeof seen / sizeof *seen; t++) {
        const Vec3 *p = seen[t];
        SolidAngle whole = solid_angle_of(p);
        double found[CELLS] = {0}, chi = 0, total = 0;
        for (int i = 0; i < COUNT; i++) {
            float weight[3], u0 = random_unit(&random), u1 = random_unit(&random);
            solid_angle_sample(&whole, u0, u1, weight);
            assert_near(weight[0] + weight[1] + weight[2], 1, 1e-6);
            assert_true(weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0);
            int a = (int)(weight[1] * SIDE * 0.99999f), b = (int)(weight[2] * SIDE * 0.99999f);
            int turned =
                a + b < SIDE - 1 && weight[1] * SIDE - (float)a + weight[2] * SIDE - (float)b > 1;
            found[(2 * SIDE - a) * a + 2 * b + turned]++;
        }
        for (int a = 0; a < SIDE; a++)
            for (int k = 0; k < 2 * (SIDE - a) - 1; k++) {
                Vec3 corner[3];
                float u = (float)a, v = (float)(k / 2), step = k % 2 ? -1.0f : 1.0f;
                for (int c = 0; c < 3; c++) {
                    float s = (u + (float)(k % 2) + (c == 1 ? step : 0)) / SIDE;
                    float r = (v + (float)(k % 2) + (c == 2 ? step : 0)) / SIDE;
                    corner[c] =
                        vec3_along(vec3_along(vec3_scale(p[0], 1 - s - r), p[1], s), p[2], r);
                }
                double share = (double)(solid_angle_of(corner).value / whole.value);
                double wanted = share * COUNT, got = found[(2 * SIDE - a) * a + k];
                total += share;
                chi += wanted > 0
                           ? (got - wanted) * (got - wanted) / (wanted + 1e-5 * wanted * wanted + 1)
                           : 0;
            }
        assert_near(total, 1, 1e-3);
        if (!(chi < CELLS + 4.5 * sqrt(2.0 * CELLS)))
            fail_msg("triangle %zu: chi-square %.1f over %d pieces", t, chi, CELLS);
    }
}

/* ---- lamps ------------------------------------------------------------------------------- */

/* Mean of `count` samples, without the noise of wavelengths; their variance is added. */
static double illuminance_of(const Lights *lights, LightSet set, LitPoint point, int count,
                             double *variance) {
    uint32_t random = 3;
    Wavelengths w;
    double sum = 0, squares = 0;
    wavelengths_sample(0.5f, &w);
    for (int i = 0; i < count; i++) {
        LightSample sample;
        float u[3];
        double value = 0;
        random3(&random, u);
        if (lights_sample(lights, set, point, u, &sample))
            value = (double)(fmaxf(vec3_dot(point.ns, sample.wi), 0) *
                             lights_radiance(lights, &sample, &w)[0] / sample.pdf);
        sum += value;
        squares += value * value;
    }
    double mean = sum / count;
    assert_true(mean > 0);
    *variance += squares / count - mean * mean;
    return mean;
}

/* Of one sample, relative to the square of the mean. */
static double variance(const Lights *lights, LightSet set, LitPoint point, int count) {
    double absolute = 0, mean = illuminance_of(lights, set, point, count, &absolute);
    return absolute / (mean * mean);
}

/* Configuration factor of a rectangle a x b that a plane element faces from distance h below
 * one of its corners. */
static double corner_factor(double a, double b, double h) {
    double x = a / h, y = b / h, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
    return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * PI);
}

/* Before a large lamp light comes from everywhere: uniform directions of the hemisphere have
 * a variance of 1/3, whatever the distance. A tenth of the choices is blind and seldom of use,
 * some go to neighbours on the horizon: 4/3 / 0.85 - 1 = 0.57. */
ARENA_TEST(a_lamp_near_at_hand_is_chosen_by_solid_angle) {
    Scene *scene = builder_scene(&arena);
    builder_part(scene, builder_lamp(1000));
    builder_quad(scene, vec3(0, 0, 0), vec3(0.5f, 0, 0), vec3(0, 0, -0.5f));
    const Lights *lights = build(scene, &arena);
    const float away[] = {0.3f, 0.03f, 3e-3f, 3e-4f};
    for (int i = 0; i < 4; i++) {
        LitPoint before = {vec3(0.1f, away[i], 0.07f), vec3(0, -1, 0), false};
        LitPoint beside = {vec3(0.5f + away[i], 0.5f * away[i], 0.07f), vec3(-1, 0, 0), false};
        double facing = variance(lights, LIGHTS_EMITTERS, before, 40000);
        double grazing = variance(lights, LIGHTS_EMITTERS, beside, 40000);
        print_message("%g m before the lamp %.3f, beside it %.3f\n", (double)away[i], facing,
                      grazing);
        assert_true(facing < 0.6 && grazing < 0.6);
        double h = (double)away[i];
        double factor = corner_factor(0.6, 0.57, h) + corner_factor(0.6, 0.43, h) +
                        corner_factor(0.4, 0.57, h) + corner_factor(0.4, 0.43, h);
        assert_mean("before", illuminance(lights, LIGHTS_EMITTERS, before.position, before.ns),
                    PI * 1000 * factor);
    }
}

/* Nothing is chosen that lies below the horizon, nor a lamp that shows its back. */
ARENA_TEST(lamps_that_cannot_be_seen_are_not_chosen) {
    Scene *scene = builder_scene(&arena);
    uint32_t random = 9;
    builder_part(scene, builder_lamp(10));
    builder_quad(scene, vec3(0, 2, 0), vec3(0.1f, 0, 0), vec3(0, 0, 0.1f)); /* seen */
    builder_part(scene, builder_lamp(1e6f));
    builder_quad(scene, vec3(0, -2, 0), vec3(0.1f, 0, 0), vec3(0, 0, -0.1f)); /* below */
    builder_part(scene, builder_lamp(1e6f));
    builder_quad(scene, vec3(1, 2, 0), vec3(0.1f, 0, 0), vec3(0, 0, -0.1f)); /* turned away */
    const Lights *lights = build(scene, &arena);
    LitPoint point = {vec3(0, 0, 0), vec3(0, 1, 0), false};
    for (int i = 0; i < 1000; i++) {
        LightSample sample;
        float u[3];
        random3(&random, u);
        assert_true(lights_sample(lights, LIGHTS_EMITTERS, point, u, &sample));
        assert_true(sample.triangle < 2);
    }
    point.both_sides = true; /* now the lamp below counts, too */
    int below = 0;
    for (int i = 0; i < 1000; i++) {
        LightSample sample;
        float u[3];
        random3(&random, u);
        assert_true(lights_sample(lights, LIGHTS_EMITTERS, point, u, &sample));
        below += sample.wi.y < 0;
    }
    assert_true(below > 850); /* the third is turned away, but for a blind share */
}

/* ---- masks ------------------------------------------------------------------------------- */

TEST(a_mask_is_there_from_its_cutoff_on) {
    Material mask = builder_lamp(1);
    mask.alpha_mode = ALPHA_MASK;
    mask.alpha_cutoff = 0.25f;
    mask.base_color[3] = 0.5f;
    assert_near(coverage_alpha(&mask, 0.5f), 1, 0);
    assert_near(coverage_alpha(&mask, 0.499f), 0, 0);
}

/* ---- many lamps -------------------------------------------------------------------------- */

typedef enum LampKind { SQUARES, TURNED_SQUARES, POINTS, SPOTS } LampKind;

static void add_lamp(Scene *scene, LampKind kind, Vec3 at, int count, uint32_t *random) {
    float side = 0.5f / sqrtf((float)count), cd = 100 / (float)count;
    Vec3 aim = vec3(random_unit(random) - 0.5f, -1, random_unit(random) - 0.5f);
    Frame frame = frame_from_z(vec3_normalize(aim));
    switch (kind) {
    case SQUARES: builder_quad(scene, at, vec3(side, 0, 0), vec3(0, 0, side)); break;
    case TURNED_SQUARES:
        builder_quad(scene, at, vec3_scale(frame.x, side), vec3_scale(frame.y, side));
        break;
    case POINTS:
    case SPOTS:
        scene->lights[scene->light_count++] =
            (PunctualLight){.kind = kind == POINTS ? LIGHT_POINT : LIGHT_SPOT,
                            .position = at,
                            .intensity = {cd, cd, cd},
                            .direction = frame.z,
                            .cos_inner = 0.95f,
                            .cos_outer = 0.6f};
    }
}

/* Lamps of the same light together on a grid under the ceiling of 6 x 5 m. */
static const Lights *lamps_on_grid(LampKind kind, int count, Arena *arena) {
    Scene *scene = builder_scene(arena);
    int columns = count > 1 ? count / 10 : 1;
    uint32_t random = 5;
    scene->lights = ARENA_NEW(arena, PunctualLight, count);
    builder_part(scene, builder_lamp(1000));
    for (int i = 0; i < count; i++)
        add_lamp(scene, kind,
                 vec3(6 * ((float)(i % columns) + 0.5f) / (float)columns, 2.9f,
                      5 * ((float)(i / columns) + 0.5f) / (count > 1 ? 10 : 1)),
                 count, &random);
    return build(scene, arena);
}

/* Of all points of the floor and of a wall together: squares of what one sample misses, over
 * those of the light. One lamp has next to none; that of a bounce's own direction is 1/3,
 * beside which a tenth is hardly seen. */
TEST(a_thousand_lamps_are_hardly_noisier_than_one) {
    static const char *const names[] = {"squares", "turned squares", "points", "spots"};
    for (int kind = SQUARES; kind <= SPOTS; kind++)
        for (int count = 100; count <= 1000; count *= 10) {
            Arena arena = test_arena(state);
            const Lights *lights = lamps_on_grid((LampKind)kind, count, &arena);
            LightSet set = kind < POINTS ? LIGHTS_EMITTERS : LIGHTS_PUNCTUAL;
            double missed = 0, light = 0;
            uint32_t random = 77;
            for (int i = 0; i < 48; i++) {
                Vec3 on_floor = {6 * random_unit(&random), 0, 5 * random_unit(&random)};
                Vec3 on_wall = {0, 2.5f * random_unit(&random), 5 * random_unit(&random)};
                LitPoint point = {i % 2 ? on_wall : on_floor, i % 2 ? vec3(1, 0, 0) : vec3(0, 1, 0),
                                  false};
                double mean = illuminance_of(lights, set, point, 4000, &missed);
                light += mean * mean;
            }
            print_message("%4d %s: variance %.3f\n", count, names[kind], missed / light);
            assert_true(missed / light < 0.1);
        }
}

TEST_PROGRAM(make_arena, drop_arena)
