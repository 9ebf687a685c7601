/* SPDX-License-Identifier: Apache-2.0 */
/* The statistical test: how small a change it finds, and what it says of it. */
#include "statistic_fixture.h"

#include "compare/metrics/change.h"

/* Gaussian pixels of relative sigma s = 0.5 / 4 in both frames: the best estimate of a change
 * in proportion has the standard error s sqrt(2 / n). */
ARENA_TEST(a_change_in_proportion_is_measured_as_well_as_can_be) {
    Maker maker = plain_maker(NOISE_GAUSSIAN, 16, 0), other = maker;
    double sigma = 0.5 / sqrt(16) * sqrt(2.0 / (PIXELS - 36)), mean = 0, stated = 0;
    int found = 0;
    for (int i = 0; i < PIXELS; i++) other.light[i] *= 1 + 6.2 * sigma;
    for (uint32_t k = 0; k < 100; k++) {
        StatisticResult r = judge_pair(&maker, &other, k, arena);
        mean += r.regions[0].change / 100;
        stated += r.regions[0].change_sigma / 100;
        found += r.verdict == STATISTIC_DIFFERENT && r.regions[0].moved;
        if (r.verdict == STATISTIC_DIFFERENT) assert_text_has(r.reason, " %");
    }
    assert_close(stated, sigma, 0.12);
    assert_near(mean, 6.2 * sigma, 4 * sigma / sqrt(100.0));
    assert_true(found >= 97); /* 6.2 sigma against a limit of about 3.7 */
}

/* Weighing by the pixel's own variance makes bright pixels count less; the estimate knows. */
ARENA_TEST(a_change_is_estimated_without_bias_in_skewed_noise) {
    Maker maker = plain_maker(NOISE_EXPONENTIAL, 16, 0), other = maker;
    double mean = 0, squares = 0, stated = 0;
    for (int i = 0; i < PIXELS; i++) other.light[i] *= 1.05;
    for (uint32_t k = 0; k < 100; k++) {
        StatisticRegion frame = judge_pair(&maker, &other, k, arena).regions[0];
        mean += frame.change / 100;
        stated += frame.change_sigma / 100;
        squares += (frame.change - 0.05) * (frame.change - 0.05) / 100;
    }
    assert_near(mean, 0.05, 4 * stated / sqrt(100.0));
    assert_close(sqrt(squares), stated, 0.28); /* 4 / sqrt(2 * 100) */
}

ARENA_TEST(a_display_is_named_with_how_much_it_moved) {
    Maker maker = plain_maker(NOISE_GAUSSIAN, 64, 7);
    Maker other = plain_maker(NOISE_GAUSSIAN, 64, 8);
    for (int i = 0; i < PIXELS; i++) other.light[i] *= i % WIDTH < 24 ? 1.05 : 1;
    StatisticResult r = judge_makers(&maker, &other, &arena);
    assert_int_equal(r.verdict, STATISTIC_DIFFERENT);
    assert_int_equal(r.region_count, 3);
    assert_string_equal(r.regions[2].name, "cluster reflected");
    assert_near(r.regions[1].change, 0.05, 4 * r.regions[1].change_sigma);
    assert_text_has(r.reason, "display cluster ");
}

ARENA_TEST(a_block_is_named_with_its_place) {
    Maker maker = plain_maker(NOISE_EXPONENTIAL, 64, 3);
    Maker other = plain_maker(NOISE_EXPONENTIAL, 64, 4);
    brighten_block(&other, 16, 8, 1.5);
    StatisticResult r = judge_makers(&maker, &other, &arena);
    assert_int_equal(r.verdict, STATISTIC_DIFFERENT);
    assert_text_has(r.reason, "block at x 16..24, y 8..16: ");
    assert_text_has(r.reason, " %");
    assert_true(r.block_p[1 * r.blocks_x + 2] < 1e-6f);
    assert_true(r.block_p[2 * r.blocks_x + 2] > 1e-4f);
    assert_true(r.fraction_failed > 0);
}

/* Blocks that got brighter and darker by 1.4 of their standard errors, in turn: none of them
 * is beyond its limit, no mean moved. */
ARENA_TEST(small_changes_everywhere_are_seen_together) {
    Maker maker = {.noise = NOISE_GAUSSIAN, .samples = 16};
    int found = 0, by_histogram = 0;
    for (int i = 0; i < PIXELS; i++) maker.light[i] = 10;
    Maker other = maker;
    double error = 0.5 / 4 * sqrt(2.0) / 8;
    for (int i = 0; i < PIXELS; i++)
        other.light[i] *= 1 + 2 * error * ((i / 8 + i / WIDTH / 8) % 2 ? 1 : -1);
    for (uint32_t k = 0; k < 20; k++) {
        StatisticResult r = judge_pair(&maker, &other, k, arena);
        found += r.verdict == STATISTIC_DIFFERENT;
        if (r.p_blocks < 0.0034 || r.p_regions < 0.0034 || r.p_histogram > 0.003) continue;
        by_histogram++;
        assert_text_has(r.reason, "small changes all over the frame");
    }
    assert_true(found >= 19);
    assert_true(by_histogram >= 10);
}

/* ---- one pixel --------------------------------------------------------------------------- */

static Standout standout_of(FrameImage frames[2], Arena *arena) {
    StatisticResult r = judge(&frames[0], &frames[1], NULL, arena);
    unsigned char mask[PIXELS];
    Planes light[2];
    memset(mask, 1, sizeof mask);
    for (int s = 0; s < 2; s++) {
        light[s] = (Planes){WIDTH, HEIGHT, {NULL}};
        for (int c = 0; c < 3; c++) light[s].rgb[c] = frame_channel(&frames[s], &"R\0G\0B"[2 * c]);
    }
    return change_standout((const Planes *const[2]){&light[0], &light[1]}, mask, r.sigma, *arena);
}

/* Noise of any kind and number of samples explains itself; a pixel that all samples agree on is
 * found on either side, from four samples on. */
ARENA_TEST(noise_explains_itself_and_no_pixel_that_is_lit) {
    static const int SAMPLES[] = {1, 2, 4, 8, 32};
    for (uint32_t k = 0; k < 300; k++) {
        Arena scratch = arena;
        int samples = SAMPLES[k % 5];
        Maker a = plain_maker((Noise)(k % 4), samples, 2 * k);
        Maker b = plain_maker((Noise)(k % 4), samples, 2 * k + 1);
        FrameImage frames[2] = {make_frame(&a, &scratch), make_frame(&b, &scratch)};
        Standout found = standout_of(frames, &scratch);
        assert_true(!found.count || found.is_explained);
        for (int c = 0; c < 3; c++)
            ((float *)frame_channel(&frames[k % 2], &"R\0G\0B"[2 * c]))[20 * WIDTH + 20] = 2e6f;
        found = standout_of(frames, &scratch);
        assert_int_equal(found.most.x, 20);
        if (samples >= 4) assert_false(found.is_explained);
    }
}

static void set_pixel(FrameImage *frame, const char *layer, double value) {
    for (int c = 0; c < 3; c++) {
        const char *name = layer[0] ? (const char *[]){"variance.R", "variance.G", "variance.B"}[c]
                                    : &"R\0G\0B"[2 * c];
        ((float *)frame_channel(frame, name))[20 * WIDTH + 20] = (float)value;
    }
}

/* A glint that half of a pixel's samples hit: of few samples all may, or none. */
ARENA_TEST(a_glint_that_few_samples_hit_or_miss_is_noise) {
    Random random = {7};
    int all_or_none = 0;
    for (uint32_t k = 0; k < 200; k++) {
        Arena scratch = arena;
        int samples = k % 2 ? 2 : 4;
        Maker maker = plain_maker(NOISE_QUIET, samples, k);
        FrameImage frames[2] = {make_frame(&maker, &scratch), make_frame(&maker, &scratch)};
        double means[2];
        for (int s = 0; s < 2; s++) {
            double sum = 0, squares = 0;
            for (int i = 0; i < samples; i++) {
                double value = unit(&random) < 0.5 ? 2e4 * (0.9 + 0.2 * unit(&random)) : 0.1;
                sum += value;
                squares += value * value;
            }
            means[s] = sum / samples;
            set_pixel(&frames[s], "", means[s]);
            set_pixel(&frames[s], "variance", (squares - sum * means[s]) / (samples - 1) / samples);
        }
        all_or_none += fabs(means[0] - means[1]) > 1.7e4;
        Standout found = standout_of(frames, &scratch);
        assert_true(!found.count || found.is_explained);
    }
    assert_true(all_or_none > 5);
}

TEST_PROGRAM(make_arena, drop_arena)
