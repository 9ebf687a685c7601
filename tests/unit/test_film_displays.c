/* SPDX-License-Identifier: Apache-2.0 */
/* Displays' light in a film: its variance, and a pixel that shows two or more of them. */
#include "film_samples.h"

#include "base/count.h"
#include "film/pixels.h"
#include "spectrum/photometry.h"

#define LAYERS (LAYER_DISPLAY_VARIANCE | LAYER_DISPLAY_SECOND | LAYER_ID)

/* A grey sample of a display's light; id -1: of what is around it. */
static void add_display(Film *film, int x, uint32_t index, int id, float cd_m2) {
    float grey[3] = {cd_m2, cd_m2, cd_m2};
    FilmSample s = {.sample_index = index, .hit = true, .part_id = 1, .display_id = id};
    xyz_from_rgb(grey, s.xyz);
    s.emitted[1] = id >= 0 ? 0.25f * cd_m2 : 0;
    film_add_sample(film, x, 0, &s);
}

static const float firsts[] = {10, 12, 14, 30}, seconds[] = {1000, 1300};

/* Of the display's own samples alone: sum (v - mean)^2 / (n (n - 1)). */
static double variance_of(const float *values, int count) {
    double mean = 0, squares = 0;
    for (int i = 0; i < count; i++) mean += (double)values[i] / count;
    for (int i = 0; i < count; i++)
        squares += ((double)values[i] - mean) * ((double)values[i] - mean);
    return squares / (count * (count - 1.0));
}

ARENA_TEST(a_displays_light_has_its_own_variance) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYERS, NULL, &arena);
    for (uint32_t i = 0; i < 4; i++) {
        add_display(film, 0, 2 * i, 1, firsts[i]);
        add_display(film, 0, 2 * i + 1, -1, 9000 * (float)(i + 1)); /* moves nothing */
    }
    add_display(film, 1, 0, 1, 7);
    FrameImage frame = film_to_frame(film, 0, &arena);
    assert_close(at(&frame, "display.variance.G", 0), variance_of(firsts, 4), 1e-5);
    assert_close(at(&frame, "display.coverage", 0), 0.5, 1e-7);
    assert_close(at(&frame, "samples.N", 0), 8, 1e-7);
    assert_true(isnan(at(&frame, "display.variance.G", 1))); /* of one sample */
    assert_true(isnan(at(&frame, "display.variance.G", 2))); /* of none */
    assert_close(at(&frame, "id.second", 0), -1, 1e-7);
    assert_true(at(&frame, "display.second.coverage", 0) == 0);
}

/* Whatever the numbers, and in whatever order the samples come: the other display is told
 * exactly. The lowest sample index decides which of the two is the other. */
ARENA_TEST(the_second_display_of_a_pixel_is_told) {
    static const int ids[][2] = {{0, 1}, {1, 0}, {7, 3}, {2, 60000}, {60000, 0}};
    for (int k = 0; k < COUNT_OF(ids); k++) {
        for (int order = 0; order < 2; order++) {
            Arena scratch = arena;
            Film *film = film_create(WIDTH, HEIGHT, whole, LAYERS, NULL, &scratch);
            for (uint32_t n = 0; n < 7; n++) {
                uint32_t i = order ? 6 - n : n;
                if (i < 4) add_display(film, 0, i, ids[k][0], firsts[i]);
                else if (i < 6) add_display(film, 0, i, ids[k][1], seconds[i - 4]);
                else add_display(film, 0, i, -1, 5);
            }
            FrameImage frame = film_to_frame(film, 0, &scratch);
            assert_close(at(&frame, "id.display", 0), ids[k][0], 1e-9);
            assert_close(at(&frame, "id.second", 0), ids[k][1], 1e-9);
            assert_close(at(&frame, "display.second.coverage", 0), 2 / 7.0, 1e-6);
            assert_close(at(&frame, "display.second.R", 0), 1150, 1e-5);
            assert_close(at(&frame, "display.second.variance.B", 0), variance_of(seconds, 2), 1e-4);
        }
    }
}

/* Three are not told apart, and are not taken for two. */
ARENA_TEST(three_displays_are_not_taken_for_two) {
    static const int ids[][3] = {{0, 1, 2}, {1, 0, 2}, {0, 1, 3}, {5, 4, 7}, {2, 1, 0}};
    for (int k = 0; k < COUNT_OF(ids); k++)
        for (uint32_t many = 1; many < 12; many++) {
            Arena scratch = arena;
            Film *film = film_create(WIDTH, HEIGHT, whole, LAYERS, NULL, &scratch);
            uint32_t index = 0;
            add_display(film, 0, index++, ids[k][0], 5);
            for (uint32_t i = 0; i < many; i++) add_display(film, 0, index++, ids[k][1], 6);
            for (uint32_t i = 0; i < 4; i++) add_display(film, 0, index++, ids[k][2], 7);
            FrameImage frame = film_to_frame(film, 0, &scratch);
            assert_close(at(&frame, "id.second", 0), -2, 1e-9);
            assert_true(isnan(at(&frame, "display.second.R", 0)));
        }
}

TEST_PROGRAM(make_arena, drop_arena)
