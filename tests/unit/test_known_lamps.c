/* SPDX-License-Identifier: Apache-2.0 */
/* What a cell knows of its lamps: it decides how often each is chosen, never what they give. */
#include "light_fixture.h"

#include "path/cell_lights.h"

#define FLOOR_POINT ((LitPoint){{0.4f, 0, -0.3f}, {0, 1, 0}, false})

/* Points of 10 to 10 * count cd in a row, 3 m up. */
static Scene *row_of_lamps(int count, Arena *arena) {
    Scene *scene = builder_scene(arena);
    scene->lights = ARENA_NEW(arena, PunctualLight, count);
    for (int i = 0; i < count; i++) {
        float cd = 10 * (float)(i + 1);
        scene->lights[scene->light_count++] =
            (PunctualLight){.kind = LIGHT_POINT,
                            .intensity = {cd, cd, cd},
                            .position = {(float)(i - count / 2), 3, 0.2f * (float)(i % 3)}};
    }
    return scene;
}

static double lux_of(const PunctualLight *light, const LitPoint *point) {
    Vec3 to = vec3_sub(light->position, point->position);
    double d = (double)vec3_length(to);
    return (double)(light->intensity[0] * vec3_dot(to, point->ns)) / (d * d * d);
}

/* Of all lamps; chosen[id]: how often each was. */
static Mean lux_by_known(const Scene *scene, const Lights *lights, const PunctualKnown *known,
                         int chosen[]) {
    Mean mean = {0};
    uint32_t random = 7;
    LitPoint point = FLOOR_POINT;
    Wavelengths w;
    wavelengths_sample(0.5f, &w);
    for (int i = 0; i < SAMPLES; i++) {
        LightSample sample;
        float u[3];
        double value = 0;
        random3(&random, u);
        if (lights_sample_known(lights, known, point, u, &sample)) {
            const PunctualLight *light = &scene->lights[sample.light_id];
            Vec3 to = vec3_sub(light->position, point.position);
            double lux = 1 / (double)vec3_dot(to, to);
            chosen[sample.light_id]++;
            value = lux_of(light, &point) * (double)sample.scale / lux;
        }
        mean_add(&mean, value);
    }
    return mean;
}

TEST(what_is_known_moves_no_mean) {
    static const PunctualKnown known[] = {
        {.count = 3, .id = {4, 1, 7}, .arrives = {1, 0.1f, 0.5f}, .others = 0.1f},
        {.count = 1, .id = {0}, .arrives = {0.1f}, .others = 0.5f},
        {.count = 2, .id = {9, 0}, .arrives = {0.3f, 0.3f}, .others = 0.9f},
        {.count = 8,
         .id = {0, 1, 2, 3, 4, 5, 6, 7},
         .others = 0.1f,
         .arrives = {1, 0.9f, 0.8f, 0.7f, 0.6f, 0.5f, 0.4f, 0.1f}}};
    static const int counts[] = {10, 100};
    for (size_t c = 0; c < 2; c++)
        for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
            Arena arena = test_arena(state);
            Scene *scene = row_of_lamps(counts[c], &arena);
            int chosen[100] = {0};
            double wanted = 0;
            LitPoint point = FLOOR_POINT;
            for (int i = 0; i < counts[c]; i++) wanted += lux_of(&scene->lights[i], &point);
            assert_mean("lamps", lux_by_known(scene, build(scene, &arena), &known[k], chosen),
                        wanted);
        }
}

/* One way to each lamp: 0.9 of the samples go to the known two by their light times what
 * arrives of it, and what else finds them counts nothing. */
ARENA_TEST(known_lamps_are_chosen_by_what_arrives) {
    Scene *scene = row_of_lamps(20, &arena);
    LitPoint point = FLOOR_POINT;
    int chosen[20] = {0};
    PunctualKnown known = {.count = 2, .id = {8, 11}, .arrives = {1, 0.2f}, .others = 0.1f};
    lux_by_known(scene, build(scene, &arena), &known, chosen);
    double a = lux_of(&scene->lights[8], &point), b = 0.2 * lux_of(&scene->lights[11], &point);
    double soft = 0.1 * SAMPLES; /* a cosine is taken as a tenth and nine of itself */
    print_message("%d and %d of %d, by light %.0f and %.0f\n", chosen[8], chosen[11], SAMPLES,
                  0.9 * SAMPLES * a / (a + b), 0.9 * SAMPLES * b / (a + b));
    assert_near(chosen[8] + chosen[11], 0.9 * SAMPLES, 5 * sqrt(0.09 * SAMPLES));
    assert_near(chosen[8], 0.9 * SAMPLES * a / (a + b), soft * 0.2);
}

ARENA_TEST(where_all_lamps_are_known_no_sample_looks_for_others) {
    Scene *scene = row_of_lamps(5, &arena);
    PunctualKnown known = {.count = 5, .id = {4, 3, 2, 1, 0}, .arrives = {1, 1, 0.5f, 1, 0.1f}};
    int chosen[5] = {0}, all = 0;
    double wanted = 0;
    LitPoint point = FLOOR_POINT;
    for (int i = 0; i < 5; i++) wanted += lux_of(&scene->lights[i], &point);
    assert_mean("all", lux_by_known(scene, build(scene, &arena), &known, chosen), wanted);
    for (int i = 0; i < 5; i++) all += chosen[i];
    assert_int_equal(all, SAMPLES);
}

/* ---- what a cell keeps ------------------------------------------------------------------- */

TEST(a_cell_keeps_the_lamps_of_which_most_arrives) {
    LampFinds finds = {0};
    for (int round = 0; round < 2; round++)
        for (int i = 0; i < 12; i++) lamp_finds_add(&finds, (LampFind){i, 10, i % 2 ? 0.5 * i : 0});
    GuideLamps lamps = cell_lamps_keep(&finds, 100);
    assert_int_equal(lamps.count, 6); /* 11, 9, 7, 5, 3, 1; no light of the others arrived */
    for (int i = 0; i < 6; i++) {
        assert_int_equal(lamps.id[i], 11 - 2 * i);
        assert_near(lamps.arrives[i], fmax(0.05 * (11 - 2 * i), 0.1), 1e-6);
    }
    assert_near(lamps.others, 0.1, 1e-6);
}

TEST(a_cell_with_many_lamps_leaves_samples_to_the_rest) {
    LampFinds finds = {0};
    for (int i = 0; i < 40; i++) lamp_finds_add(&finds, (LampFind){i, 2, 1 + 0.01 * i});
    assert_int_equal(finds.count, LAMP_FINDS);
    GuideLamps lamps = cell_lamps_keep(&finds, 40);
    assert_int_equal(lamps.count, GUIDE_LAMPS);
    assert_int_equal(lamps.id[0], 39);
    double all = 0, kept = 0;
    for (int i = 0; i < finds.count; i++) all += finds.lamp[i].arrived;
    for (int i = 32; i < 40; i++) kept += 1 + 0.01 * i;
    assert_near(lamps.others, 1 - kept / all, 1e-5);
}

TEST(a_cell_of_few_lamps_keeps_the_dark_ones_too) {
    LampFinds finds = {0};
    GuideLamps none;
    lamp_finds_add(&finds, (LampFind){0, 5, 0});
    none = cell_lamps_keep(&finds, 2);
    assert_int_equal(none.count, 0); /* no light at all: nothing is known */
    lamp_finds_add(&finds, (LampFind){1, 5, 4});
    GuideLamps lamps = cell_lamps_keep(&finds, 2);
    assert_int_equal(lamps.count, 2);
    assert_int_equal(lamps.id[0], 1);
    assert_near(lamps.arrives[0], 0.8, 1e-6);
    assert_near(lamps.arrives[1], 0.1, 1e-6);
    assert_near(lamps.others, 0, 0);
    LampFinds joined = {0};
    lamp_finds_join(&joined, &finds, 0.25);
    assert_near(joined.lamp[1].sent, 1.25, 1e-12);
    assert_near(joined.lamp[1].arrived, 1, 1e-12);
}

TEST_PROGRAM(make_arena, drop_arena)
