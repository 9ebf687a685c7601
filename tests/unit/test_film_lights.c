/* SPDX-License-Identifier: Apache-2.0 */
/* What groups of lights give: kept apart, and together what the frame has. */
#include "film_fixture.h"

#include "film/film_frame.h"
#include "film/pixels.h"
#include "spectrum/photometry.h"

static const FilmRect two_pixels = {0, 0, 2, 1};
static const char *const group_names[] = {"sun", "lamp", "sky"};
static const FilmLights groups = {3, group_names};

/* Over 18 powers of ten, negative ones too, in shares of any number of groups that miss it by
 * rounding. */
static FilmSample sample_of(uint32_t index, FilmLight lights[3]) {
    uint32_t random = hash_u32(index);
    FilmSample s = {.sample_index = index,
                    .lights = lights,
                    .light_count = (int)(4 * random_unit(&random)) % 4};
    for (int i = 0; i < 3; i++)
        s.xyz[i] =
            powf(10, -6 + 18 * random_unit(&random)) * (random_unit(&random) < 0.1f ? -1 : 1);
    for (int k = 0; k < s.light_count; k++) {
        lights[k].group = (k + (int)index) % 3;
        for (int i = 0; i < 3; i++) lights[k].xyz[i] = s.xyz[i] / (float)s.light_count;
    }
    return s;
}

static Fixed sum_of_groups(const Film *film, const PixelSums *sums, int c) {
    Fixed sum = 0;
    for (int g = 0; g < film->lights.count; g++) sum += sums->layers[film->first_light + 3 * g + c];
    return sum;
}

/* Of a sample that has no group nothing is kept apart. */
ARENA_TEST(groups_of_lights_add_up_to_the_frame_to_the_step) {
    Film *film = film_create(2, 1, two_pixels, LAYER_LIGHT, &groups, &arena);
    Fixed left[3] = {0, 0, 0}, all[3] = {0, 0, 0};
    long unequal = 0;
    for (uint32_t i = 0; i < 2000; i++) {
        FilmLight lights[3];
        FilmSample sample = sample_of(i, lights);
        film_add_sample(film, sample.light_count ? 0 : 1, 0, &sample);
    }
    for (int c = 0; c < 3; c++) {
        all[c] = film_sums(film, 0, 0)->xyz[c];
        left[c] = all[c] - sum_of_groups(film, film_sums(film, 0, 0), c);
        unequal += left[c] != 0;
        assert_true(sum_of_groups(film, film_sums(film, 1, 0), c) == 0);
        assert_true(film_sums(film, 1, 0)->xyz[c] != 0);
    }
    assert_true(all[0] != 0 && unequal == 0);
}

/* What rounding leaves goes where the most is; the others keep what they were given. */
ARENA_TEST(rounding_goes_to_the_brightest_group) {
    Film *film = film_create(2, 1, two_pixels, LAYER_LIGHT, &groups, &arena);
    FilmLight lights[] = {{2, {1, 1, 1}}, {0, {7.000001f, 7, 7.000002f}}, {1, {2, 2, 2}}};
    FilmSample sample = {.xyz = {10, 10, 10}, .lights = lights, .light_count = 3};
    film_add_sample(film, 0, 0, &sample);
    FrameImage frame = film_to_frame(film, 0, &arena);
    for (int c = 0; c < 3; c++) {
        float rgb[3], of_sun[3] = {7, 7, 7};
        rgb_from_xyz(of_sun, rgb);
        const char *name = arena_format(&arena, "light.sun.%c", "RGB"[c]);
        assert_true(frame_channel(&frame, name)[0] == rgb[c]);
    }
    assert_non_null(frame_channel(&frame, "light.sky.G"));
    assert_true(frame_channel(&frame, "light.lamp.G")[1] == 0);
}

/* Huge light that one group takes away from another is nobody's but the brightest's. */
ARENA_TEST(groups_that_are_out_of_range_spoil_no_other) {
    Film *film = film_create(2, 1, two_pixels, LAYER_LIGHT, &groups, &arena);
    FilmLight lights[] = {{0, {3, 3, 3}}, {1, {INFINITY, 1, 1}}, {2, {1, NAN, 1}}};
    FilmSample sample = {.xyz = {5, 5, 5}, .lights = lights, .light_count = 3};
    film_add_sample(film, 0, 0, &sample);
    for (int c = 0; c < 3; c++) {
        const PixelSums *sums = film_sums(film, 0, 0);
        assert_true(sums->layers[film->first_light + c] == sums->xyz[c]);
        assert_true(sum_of_groups(film, sums, c) == sums->xyz[c]);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
