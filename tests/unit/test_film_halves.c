/* SPDX-License-Identifier: Apache-2.0 */
/* The film's halves: what well-spread samples leave of the noise. */
#include "film_samples.h"

#include "base/units.h"
#include "spectrum/photometry.h"

/* 80 samples in blocks of 16, the second and fourth of which are odd: 32 against 48. */
ARENA_TEST(halves_are_the_difference_of_interleaved_blocks) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_HALVES, NULL, &arena);
    for (uint32_t i = 80; i-- > 0;) add_grey(film, 0, 0, i, i / 16 % 2 ? 9.0f : 4.0f);
    for (uint32_t i = 0; i < 23; i++) add_grey(film, 1, 0, i, 4); /* the odd half is short */
    for (uint32_t i = 0; i < 24; i++) add_grey(film, 0, 1, i, i / 16 % 2 ? 9.0f : 4.0f);
    FrameImage frame = film_to_frame(film, 0, &arena);
    float grey[3] = {1, 1, 1}, rgb[3];
    rgb_from_xyz(grey, rgb);
    double half = (9 - 4) * sqrt(32.0 * 48) / 80;
    assert_close(at(&frame, "halves.R", 0), half * (double)rgb[0], 1e-6);
    assert_close(at(&frame, "halves.G", 0), half * (double)rgb[1], 1e-6);
    assert_close(at(&frame, "halves.B", 0), half * (double)rgb[2], 1e-6);
    assert_close(film_pixel(film, 0, 0).sigma_y, half * sqrt(PI / 2), 1e-6);
    assert_true(isnan(at(&frame, "halves.G", 1)));
    assert_close(at(&frame, "halves.G", WIDTH), 5 * sqrt(8.0 * 16) / 24 * (double)rgb[1], 1e-6);
}

/* What a display emits differs from sample to sample, and is not in them; nor are samples that
 * saw no display, 20 of the 48 even ones. */
ARENA_TEST(display_halves_are_those_of_the_reflected) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_DISPLAY_HALVES, NULL, &arena);
    FilmSample s = display_sample(0, 0.5f, 1);
    for (uint32_t i = 0; i < 80; i++) {
        bool is_odd = i / 16 % 2;
        for (int c = 0; c < 3; c++) {
            s.emitted[c] = (float)(i % 7);
            s.xyz[c] = s.emitted[c] + (is_odd ? 9.0f : 4.0f);
        }
        s.sample_index = i;
        s.display_id = i < 10 || i >= 70 ? -1 : 1;
        film_add_sample(film, 0, 0, &s);
    }
    FrameImage frame = film_to_frame(film, 0, &arena);
    float grey[3] = {1, 1, 1}, rgb[3];
    rgb_from_xyz(grey, rgb);
    double half = (9 - 4) * sqrt(32.0 * 28) / 60;
    assert_close(at(&frame, "display.halves.R", 0), half * (double)rgb[0], 1e-6);
    assert_close(at(&frame, "display.halves.G", 0), half * (double)rgb[1], 1e-6);
    assert_true(isnan(at(&frame, "display.halves.G", 1)));
}

/* Over many pixels of independent samples the square of `halves` is their variance. */
ARENA_TEST(halves_squared_are_the_variance_of_independent_samples) {
    enum { SIDE = 60 };
    FilmRect square = {0, 0, SIDE, SIDE};
    Film *film = film_create(SIDE, SIDE, square, LAYER_HALVES | LAYER_VARIANCE, NULL, &arena);
    for (int p = 0; p < SIDE * SIDE; p++)
        for (uint32_t i = 0; i < 80; i++) add_grey(film, p % SIDE, p / SIDE, i, coin(p, i, 1));
    FrameImage frame = film_to_frame(film, 0, &arena);
    double squares = 0, variance = 0;
    for (int p = 0; p < SIDE * SIDE; p++) {
        squares += at(&frame, "halves.G", p) * at(&frame, "halves.G", p);
        variance += at(&frame, "variance.G", p);
    }
    assert_close(squares, variance, 0.08); /* 3 sigma: 3600 squares of a normal number */
}

TEST_PROGRAM(make_arena, drop_arena)
