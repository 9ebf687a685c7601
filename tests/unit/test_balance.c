/* SPDX-License-Identifier: Apache-2.0 */
/* Light that a filter took and that is given back: each block has its own again, flat parts
 * stay as they are, there are no seams, and what one rare path lit is not spread. */
#include "fixture.h"

#include "denoise/balance.h"

typedef struct Picture {
    int width, height;
    float *before, *after, *total;
} Picture;

static double uniform(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) * 0x1p-24;
}

static Picture picture_of(int width, int height, Arena *arena) {
    const size_t count = (size_t)width * (size_t)height;
    return (Picture){width, height, ARENA_NEW(arena, float, count), ARENA_NEW(arena, float, count),
                     ARENA_NEW(arena, float, count)};
}

static void light_of(void *user, size_t i, BalanceLight *out) {
    const Picture *picture = user;
    *out = (BalanceLight){picture->before[i], picture->after[i], picture->total[i]};
}

static void scale(void *user, size_t i, float gain) {
    ((Picture *)user)->after[i] *= gain;
}

static double balance(Picture *picture, int threads, Arena *arena) {
    return balance_run(&(BalancePicture){picture->width, picture->height, picture, light_of, scale},
                       threads, *arena);
}

/* Every level from a hundredth to a hundred, peaks among it, of which the filter cut a part,
 * and not everywhere the same part. */
static void make_cut(Picture *picture, float unit) {
    uint32_t state = 5;
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            const int i = y * picture->width + x;
            const float level = expf(4.6f * sinf(0.021f * (float)x) * cosf(0.017f * (float)y));
            const bool peak = uniform(&state) < 0.02;
            const float share = peak ? 12 : 0.8f + 0.4f * (float)uniform(&state);
            const float light = unit * level * share;
            picture->before[i] = light;
            picture->total[i] = light + 0.3f * unit;
            picture->after[i] = light * (peak ? 0.6f + 0.3f * (float)uniform(&state) : 1.01f);
        }
}

/* The relative loss of the worst block of 64x64 from the corner that is whole. */
static double worst_of(const Picture *picture) {
    double worst = 0;
    for (int y0 = 0; y0 + 64 <= picture->height; y0 += 64)
        for (int x0 = 0; x0 + 64 <= picture->width; x0 += 64) {
            double lost = 0, total = 0;
            for (int y = y0; y < y0 + 64; y++)
                for (int x = x0; x < x0 + 64; x++) {
                    const int i = y * picture->width + x;
                    lost += (double)picture->after[i] - (double)picture->before[i];
                    total += (double)picture->total[i];
                }
            worst = fmax(worst, fabs(lost / total));
        }
    return worst;
}

ARENA_TEST(every_block_has_its_light_again) {
    const int sizes[][2] = {{640, 384}, {64, 64}, {256, 64}, {64, 192}, {320, 128}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        Picture picture = picture_of(sizes[k][0], sizes[k][1], &arena);
        make_cut(&picture, 1);
        const double before = worst_of(&picture), told = balance(&picture, 2, &arena);
        print_message("%d x %d: %.4f, then %.4f\n", sizes[k][0], sizes[k][1], before,
                      worst_of(&picture));
        assert_true(before > 0.02);
        assert_true(worst_of(&picture) < BALANCE_BAND + 2e-4);
        assert_close(told, worst_of(&picture), 1e-5);
    }
}

/* Blocks of 32 to 95 pixels, and pictures that are less than one. */
ARENA_TEST(every_size_is_balanced) {
    const int sizes[] = {1, 2, 31, 63, 65, 95, 96, 97, 127, 129, 200};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (size_t j = 0; j < sizeof sizes / sizeof *sizes; j++) {
            Picture picture = picture_of(sizes[i], sizes[j], &arena);
            make_cut(&picture, 1);
            const double left = balance(&picture, 1, &arena);
            assert_true(left < BALANCE_BAND + 1e-3 || sizes[i] * sizes[j] < 64);
        }
}

ARENA_TEST(what_is_within_the_band_stays_bit_for_bit) {
    Picture picture = picture_of(200, 130, &arena), same = picture_of(200, 130, &arena);
    make_cut(&picture, 1);
    for (int i = 0; i < 200 * 130; i++)
        picture.after[i] = same.after[i] = 0.994f * picture.before[i];
    assert_true(balance(&picture, 2, &arena) < BALANCE_BAND);
    assert_memory_equal(picture.after, same.after, sizeof(float) * 200 * 130);
}

/* Peaks that were cut to a half get their light back; the flat part between them keeps its. */
ARENA_TEST(flat_parts_keep_their_light) {
    Picture picture = picture_of(256, 256, &arena);
    for (int i = 0; i < 256 * 256; i++) {
        const bool peak = i % 8 == 0 && i / 256 % 8 == 0;
        picture.total[i] = picture.before[i] = peak ? 64 : 1;
        picture.after[i] = peak ? 32 : 1;
    }
    assert_true(balance(&picture, 2, &arena) < BALANCE_BAND + 1e-4);
    assert_true(picture.after[8 * 256] > 60);
    for (int i = 0; i < 256 * 256; i++)
        if (i % 8) assert_close(picture.after[i], 1, 0.04);
}

/* A filter that takes 10 % on one side and gives 10 % on the other: no step between blocks. */
ARENA_TEST(there_are_no_seams) {
    Picture picture = picture_of(512, 192, &arena);
    for (int i = 0; i < 512 * 192; i++) {
        const float x = (float)(i % 512) / 512;
        picture.total[i] = picture.before[i] = 1;
        picture.after[i] = 1 + 0.1f * (2 * x - 1);
    }
    assert_true(balance(&picture, 2, &arena) < BALANCE_BAND + 1e-4);
    for (int i = 0; i < 512 * 192; i++) {
        assert_close(picture.after[i], 1, 0.035);
        if (i % 512) assert_true(fabsf(picture.after[i] - picture.after[i - 1]) < 0.003f);
    }
}

/* A wall of 1 with one pixel of 4,000 that the filter took: not spread over the wall around. */
ARENA_TEST(light_of_one_rare_path_is_not_spread) {
    Picture picture = picture_of(192, 192, &arena);
    for (int i = 0; i < 192 * 192; i++) picture.total[i] = picture.before[i] = picture.after[i] = 1;
    picture.total[96 * 192 + 96] = picture.before[96 * 192 + 96] = 4000;
    assert_close(balance(&picture, 2, &arena), 3999.0 / (4095 + 4000), 1e-3);
    for (int i = 0; i < 192 * 192; i++) assert_close(picture.after[i], 1, 0.02);
}

ARENA_TEST(neither_units_nor_threads_matter) {
    Picture one = picture_of(300, 300, &arena), three = picture_of(300, 300, &arena),
            large = picture_of(300, 300, &arena);
    make_cut(&one, 1);
    make_cut(&three, 1);
    make_cut(&large, 0x1p20f);
    assert_true(balance(&one, 1, &arena) == balance(&three, 3, &arena));
    balance(&large, 2, &arena);
    assert_memory_equal(one.after, three.after, sizeof(float) * 300 * 300);
    for (int i = 0; i < 300 * 300; i++) assert_close(large.after[i] * 0x1p-20f, one.after[i], 1e-5);
}

ARENA_TEST(darkness_and_what_was_not_filtered_stay) {
    Picture picture = picture_of(130, 70, &arena);
    assert_true(balance(&picture, 2, &arena) == 0);
    make_cut(&picture, 1);
    for (int i = 0; i < 130 * 70; i++)
        if (i % 130 < 64) picture.before[i] = picture.after[i] = 0;
    assert_true(balance(&picture, 2, &arena) < BALANCE_BAND + 1e-3);
    for (int i = 0; i < 130 * 70; i++)
        if (i % 130 < 64) assert_true(picture.after[i] == 0);
}

TEST_PROGRAM(make_arena, drop_arena)
