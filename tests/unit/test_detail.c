/* SPDX-License-Identifier: Apache-2.0 */
/* What a filter took besides noise comes back, and noise does not. */
#include "fixture.h"

#include "denoise/detail.h"

enum { WIDTH = 128, HEIGHT = 96, COUNT = WIDTH * HEIGHT };

#define NOISE 0.05
#define TEXTURE 0.1

/* A filtered picture that is 1 everywhere; before it were a texture, from the middle on to the
 * right, and noise. */
typedef struct Planted {
    double truth[COUNT], before[COUNT], after[COUNT];
    double told; /* the noise's standard deviation, as the frame has it */
} Planted;

static double normal(uint32_t *state) {
    double sum = -6;
    for (int k = 0; k < 12; k++) {
        *state = *state * 1664525u + 1013904223u;
        sum += (*state >> 8) * 0x1p-24;
    }
    return sum;
}

static Planted *planted(double noise, double told, Arena *arena) {
    Planted *p = ARENA_NEW(arena, Planted, 1);
    uint32_t state = 9;
    p->told = told;
    for (int i = 0; i < COUNT; i++) {
        p->truth[i] = 1 + (i % WIDTH < WIDTH / 2 ? 0 : (normal(&state) > 0 ? TEXTURE : -TEXTURE));
        p->before[i] = p->truth[i] + noise * normal(&state);
        p->after[i] = 1;
    }
    return p;
}

static void difference_of(void *user, size_t i, DetailDifference *out) {
    const Planted *p = user;
    const float difference = (float)(p->before[i] - p->after[i]);
    *out = (DetailDifference){difference * difference, (float)(p->told * p->told)};
}

static void give_back(void *user, size_t i, float share) {
    Planted *p = user;
    p->after[i] += (double)share * (p->before[i] - p->after[i]);
}

static void run(Planted *p, int threads, Arena scratch) {
    const DetailPicture picture = {WIDTH, HEIGHT, p, difference_of, give_back};
    detail_run(&picture, threads, scratch);
}

/* Mean squared error left (0) or right (1) of the middle, the squares at it left out. */
static double error_of(const Planted *p, int right) {
    const int x0 = right ? WIDTH / 2 + DETAIL_REACH : 0;
    const int x1 = right ? WIDTH : WIDTH / 2 - DETAIL_REACH;
    double sum = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = x0; x < x1; x++) {
            const double error = p->after[y * WIDTH + x] - p->truth[y * WIDTH + x];
            sum += error * error;
        }
    return sum / ((x1 - x0) * HEIGHT);
}

/* The share is 1 - N^2 / (N^2 + T^2) = s, and so the error s N^2, less than both the frame's and
 * the filtered one's. Where all is noise, squares of 81 pixels tell the share to 0.16: some
 * hundredths of it come back. */
ARENA_TEST(textures_come_back_and_noise_does_not) {
    Planted *p = planted(NOISE, NOISE, &arena);
    const double n = NOISE * NOISE, t = TEXTURE * TEXTURE;
    const double expected = (1 - n / (n + t)) * n;
    run(p, 2, arena);
    print_message("texture: %.6f, expected %.6f; noise: %.6f of %.6f\n", error_of(p, 1), expected,
                  error_of(p, 0), n);
    assert_close(error_of(p, 1), expected, 0.03);
    assert_true(error_of(p, 0) < 0.01 * n);
}

ARENA_TEST(without_noise_the_frame_comes_back) {
    Planted *p = planted(0, 0, &arena);
    run(p, 2, arena);
    for (int i = 0; i < COUNT; i++) assert_near(p->after[i], p->truth[i], 1e-7);
}

ARENA_TEST(a_speck_does_not_come_back) {
    Planted *p = planted(NOISE, 0, &arena);
    const int speck = HEIGHT / 2 * WIDTH + WIDTH / 4;
    p->before[speck] += 1;
    run(p, 2, arena);
    assert_near(p->after[speck], 1, 0);
    assert_near(p->after[speck + 1], p->before[speck + 1], 1e-6);
}

ARENA_TEST(threads_do_not_change_a_bit) {
    Planted *one = planted(NOISE, NOISE, &arena), *many = planted(NOISE, NOISE, &arena);
    run(one, 1, arena);
    run(many, 7, arena);
    assert_memory_equal(one->after, many->after, sizeof one->after);
}

TEST_PROGRAM(make_arena, drop_arena)
