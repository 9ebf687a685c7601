/* SPDX-License-Identifier: Apache-2.0 */
/* Local adaptation: what it does to flat light, to edges, to colours; and what says so. */
#include "frame_fixture.h"

#include "image/adapt.h"
#include "image/develop.h"
#include "image/exposure.h"

enum { WIDTH = 120, HEIGHT = 80, COUNT = WIDTH * HEIGHT };

static float *gains_of(const float *luminance, int width, int height, Arena *arena) {
    return adapt_gains(luminance, width, height, 10, arena);
}

/* Above middle grey a uniform picture follows the curve of one pixel, below it stays. */
ARENA_TEST(a_uniform_picture_follows_the_global_curve) {
    float *luminance = ARENA_NEW(&arena, float, COUNT);
    for (int stops = -6; stops <= 12; stops += 3) {
        for (int i = 0; i < COUNT; i++) luminance[i] = 10 * exp2f((float)stops);
        float *gains = gains_of(luminance, WIDTH, HEIGHT, &arena);
        double wanted = exp2((double)adapt_stops((float)stops) - stops);
        for (int i = 0; i < COUNT; i++) assert_close(gains[i], wanted, 1e-4);
    }
}

TEST(the_curve_rises_and_leaves_shadows) {
    assert_true(adapt_stops(-5) == -5 && adapt_stops(0) == 0);
    for (float s = -4; s < 20; s += 0.01f) {
        float rise = adapt_stops(s + 0.01f) - adapt_stops(s);
        assert_true(rise > 0 && rise < 0.01001f);
    }
    assert_near(adapt_stops(7), 1.5 * log(1 + 7 / 1.5), 1e-5);
}

/* A street beside a cabin, seven stops apart; and steps of other sizes and places. */
ARENA_TEST(a_step_has_no_halo) {
    float *luminance = ARENA_NEW(&arena, float, COUNT);
    const float brights[] = {20, 40, 1280, 40960};
    for (int k = 0; k < 4; k++)
        for (int edge = 7; edge < WIDTH; edge += 23) {
            for (int i = 0; i < COUNT; i++) luminance[i] = i % WIDTH < edge ? 10 : brights[k];
            float *gains = gains_of(luminance, WIDTH, HEIGHT, &arena);
            float bright =
                brights[k] * exp2f(adapt_stops(log2f(brights[k] / 10)) - log2f(brights[k] / 10));
            for (int i = 0; i < COUNT; i++) {
                double value = (double)(luminance[i] * gains[i]);
                assert_true(value > 10 / 1.1 && value < (double)bright * 1.1);
            }
        }
}

/* Of small contrasts inside a bright view at least nine tenths stay. */
ARENA_TEST(contrast_inside_a_bright_view_stays) {
    float *luminance = ARENA_NEW(&arena, float, COUNT);
    for (int i = 0; i < COUNT; i++) luminance[i] = (i % WIDTH / 2 + i / WIDTH / 2) % 2 ? 1000 : 900;
    float *gains = gains_of(luminance, WIDTH, HEIGHT, &arena);
    int middle = HEIGHT / 2 * WIDTH + WIDTH / 2;
    double ratio = (double)(luminance[middle] * gains[middle]) /
                   (double)(luminance[middle + 2] * gains[middle + 2]);
    assert_true(fabs(log(ratio)) > 0.9 * log(1000 / 900.0));
    assert_true(fabs(log(ratio)) < 1.001 * log(1000 / 900.0));
}

ARENA_TEST(gains_never_brighten_and_bad_pixels_harm_no_other) {
    float *luminance = ARENA_NEW(&arena, float, COUNT);
    for (int i = 0; i < COUNT; i++) luminance[i] = 500;
    const float bad[] = {NAN, INFINITY, 0, -1, -INFINITY};
    for (int k = 0; k < 5; k++) luminance[40 * WIDTH + 20 * k] = bad[k];
    float *gains = gains_of(luminance, WIDTH, HEIGHT, &arena);
    float stops = log2f(50);
    for (int i = 0; i < COUNT; i++)
        if (!(luminance[i] > 0) || isinf(luminance[i])) assert_true(gains[i] == 1);
        else assert_close(gains[i], exp2f(adapt_stops(stops) - stops), 1e-4);
    float one = 80;
    assert_close(gains_of(&one, 1, 1, &arena)[0], exp2f(adapt_stops(3) - 3), 1e-4);
}

/* The same factor for R, G and B, and words in the report. */
ARENA_TEST(hues_stay_and_the_report_says_so) {
    FrameImage frame = uniform_frame(8, 8, 0, &arena);
    DevelopOptions options = {
        .exposure = "white:100", .view = "raw", .adapt = DEVELOP_ADAPT_LOCAL, .own_config = true};
    DevelopReport report;
    Picture picture;
    const float rgb[3] = {400, 800, 200};
    for (int c = 0; c < 3; c++) {
        float *plane = (float *)(uintptr_t)frame_channel(&frame, (char[]){"RGB"[c], 0});
        for (int i = 0; i < 64; i++) plane[i] = rgb[c];
    }
    assert_done(develop_picture(&frame, &options, &arena, &picture, &report, &err));
    assert_true(report.is_adapted && !report.is_denoised);
    float stops = log2f((0.2126f * 400 + 0.7152f * 800 + 0.0722f * 200) / 18);
    float gain = exp2f(adapt_stops(stops) - stops);
    for (int c = 0; c < 3; c++) assert_close(picture.rgb[c], rgb[c] / 100 * gain, 1e-3);
    options.false_colour = true;
    assert_fails_as(develop_picture(&frame, &options, &arena, &picture, &report, &err), ERROR_USAGE,
                    "--adapt local and --false-colour exclude each other");
}

/* A frame of which the upper half is `stops` above the middle grey that is found. */
static DevelopReport developed(double stops, const char *exposure, Arena *arena) {
    FrameImage frame = uniform_frame(40, 40, 100, arena);
    DevelopOptions options = {.exposure = exposure, .own_config = true};
    DevelopReport report;
    Picture picture;
    for (int c = 0; c < 3; c++) {
        float *plane = (float *)(uintptr_t)frame_channel(&frame, (char[]){"RGB"[c], 0});
        for (int i = 0; i < 600; i++) plane[i] = (float)(150 * exp2(stops));
    }
    assert_done(develop_picture(&frame, &options, arena, &picture, &report, &err));
    assert_close(report.grey_cd_m2, 150, 1e-3);
    return report;
}

/* A street that is not much brighter than the cabin stays as it is; so does every picture of
 * a given exposure. */
ARENA_TEST(a_picture_adapts_by_itself_where_its_range_is_wide) {
    assert_false(developed(ADAPT_FROM_STOPS - 0.1, NULL, &arena).is_adapted);
    assert_true(developed(ADAPT_FROM_STOPS + 0.1, NULL, &arena).is_adapted);
    assert_true(developed(5, "auto", &arena).is_adapted);
    assert_false(
        developed(5, arena_format(&arena, "%.12g", exposure_ev_of_grey(150)), &arena).is_adapted);
}

TEST_PROGRAM(make_arena, drop_arena)
