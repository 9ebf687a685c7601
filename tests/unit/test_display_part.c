/* SPDX-License-Identifier: Apache-2.0 */
/* A display's part of a frame's pixels. */
#include "frame_fixture.h"

#include "measure/measure.h"

/* Of each channel of a layer. */
static void set(FrameImage *frame, const char *layer, int i, double value, Arena *arena) {
    static const char *const ends[] = {".R", ".G", ".B"};
    for (int c = 0; c < 3; c++) {
        const char *name = arena_format(arena, "%s%s", layer, ends[c]);
        float *plane = (float *)(uintptr_t)frame_channel(frame, name);
        if (!plane) plane = frame_add_channel(frame, name, false, arena);
        plane[i] = (float)value;
    }
}

static void set_one(FrameImage *frame, const char *name, int i, double value, Arena *arena) {
    float *plane = (float *)(uintptr_t)frame_channel(frame, name);
    if (!plane) plane = frame_add_channel(frame, name, false, arena);
    plane[i] = (float)value;
}

typedef struct Pixel {
    double id, coverage, mean, variance; /* of all that is display */
    double second_id, second_coverage, second_mean, second_variance;
} Pixel;

#define SAMPLES 16
#define NONE -1, 0, NAN, NAN

/* Pixels in a row, each of so many samples, before a wall of 9000. */
static FrameImage row_of(const Pixel *pixels, int count, Arena *arena) {
    FrameImage frame = uniform_frame(count, 1, 9000, arena);
    for (int i = 0; i < count; i++) {
        const Pixel *p = &pixels[i];
        set_one(&frame, "id.display", i, p->id, arena);
        set_one(&frame, "id.second", i, p->second_id, arena);
        set_one(&frame, "samples.N", i, SAMPLES, arena);
        set_one(&frame, "display.coverage", i, p->coverage, arena);
        set_one(&frame, "display.second.coverage", i, p->second_coverage, arena);
        set(&frame, "display.emitted", i, 0.75 * p->mean, arena);
        set(&frame, "display.reflected", i, 0.25 * p->mean, arena);
        set(&frame, "display.variance", i, p->variance, arena);
        set(&frame, "display.second", i, p->second_mean, arena);
        set(&frame, "display.second.variance", i, p->second_variance, arena);
    }
    frame_set_string(&frame, "parhelion:display.0", "a", arena);
    frame_set_string(&frame, "parhelion:display.1", "b", arena);
    return frame;
}

static FrameMeasurement measure(const FrameImage *frame, const char *display, Arena arena) {
    MeasureRequest request = {.frame_name = "f.exr", .display = display};
    FrameMeasurement m;
    assert_done(measure_frame(frame, &request, arena, &m, &err));
    return m;
}

/* (100 + 0.25 * 300) / 1.25, whatever the wall; the interval by the samples themselves. */
ARENA_TEST(a_pixel_counts_by_its_part) {
    const Pixel pixels[] = {{0, 1, 100, 4, NONE}, {0, 0.25, 300, 9, NONE}, {-1, 0, NAN, NAN, NONE}};
    FrameImage frame = row_of(pixels, 3, &arena);
    FrameMeasurement m = measure(&frame, "a", arena);
    assert_int_equal(m.rim, RIM_BY_COVERAGE);
    assert_int_equal(m.pixels, 2);
    assert_int_equal(m.rim_pixels, 1);
    assert_close(m.area, 1.25, 1e-6);
    assert_close(m.luminance.value, 140, 1e-6);
    assert_close(m.least, 100, 1e-6);
    assert_close(m.greatest, 300, 1e-6);
    /* squares about the mean of 140: of 16 samples, and of 4 among 16 that else have none */
    double whole = 4, n = SAMPLES,
           rim = 9.0 * 4 * 3 / (n * (n - 1)) + 0.25 * 0.75 / (n - 1) * 160 * 160;
    assert_close(measured_half_width(m.luminance), 1.959964 * sqrt(whole + rim) / 1.25, 1e-4);
}

/* A pixel of two displays: each has its own samples' light, and its own squares about it. */
ARENA_TEST(two_displays_share_a_pixel) {
    /* 4 samples of 100 and 8 of 10: together a mean of 40, and squares between and within */
    double within = 4 * 3 * 2.0 + 8 * 7 * 0.5, between = 4 * 60.0 * 60 + 8 * 30.0 * 30;
    const Pixel pixels[] = {{0, 0.75, 40, (within + between) / (12 * 11), 1, 0.5, 10, 0.5}};
    FrameImage frame = row_of(pixels, 1, &arena);
    DisplayLayers layers;
    assert_true(display_layers_find(&frame, &layers));
    DisplayPart a = display_part(&layers, 0, 0), b = display_part(&layers, 0, 1);
    assert_close(a.coverage, 0.25, 1e-6);
    assert_close(a.rgb[1], 100, 1e-5);
    assert_close(a.scatter[1], 4 * 3 * 2.0 / (16 * 15), 1e-3);
    assert_close(b.coverage, 0.5, 1e-6);
    assert_close(b.rgb[1], 10, 1e-6);
    assert_close(b.scatter[1], 8 * 7 * 0.5 / (16 * 15), 1e-4);
    assert_true(a.is_shared && b.is_shared && display_part(&layers, 0, 2).coverage == 0);
    assert_close(measure(&frame, "a", arena).luminance.value, 100, 1e-5);
    FrameMeasurement m = measure(&frame, "b", arena);
    assert_close(m.luminance.value, 10, 1e-5);
    assert_int_equal(m.shared_pixels, 1);
    assert_false(m.has_contrast);
}

ARENA_TEST(what_several_displays_share_is_left_out_and_counted) {
    const Pixel pixels[] = {{0, 1, 100, 4, NONE}, {0, 1, 5, 4, -2, 0, NAN, NAN}};
    FrameImage frame = row_of(pixels, 2, &arena);
    FrameMeasurement m = measure(&frame, "a", arena);
    assert_close(m.luminance.value, 100, 1e-6);
    assert_int_equal(m.pixels, 1);
    assert_int_equal(m.unknown_pixels, 1);
}

/* As in front of black: coverage times light, and its variance. */
ARENA_TEST(a_display_alone_is_a_frame) {
    const Pixel pixels[] = {{0, 0.25, 300, 9, NONE}, {1, 1, 7, 1, NONE}};
    FrameImage frame = row_of(pixels, 2, &arena);
    DisplayLayers layers;
    set(&frame, "variance", 0, 1e6, &arena);
    assert_true(display_layers_find(&frame, &layers));
    FrameImage alone = display_part_frame(&frame, &layers, 0, &arena);
    assert_close(frame_channel(&alone, "G")[0], 75, 1e-6);
    assert_true(frame_channel(&alone, "G")[1] == 0);
    assert_close(frame_channel(&frame, "G")[0], 9000, 1e-6);
    double n = SAMPLES, variance = 9.0 * 4 * 3 / (n * (n - 1)) + 0.1875 / (n - 1) * 300 * 300;
    assert_close(frame_channel(&alone, "variance.G")[0], variance, 1e-5);
    assert_true(frame_channel(&alone, "variance.G")[1] == 0);
}

/* Two displays and no layer that tells them apart in a pixel: rims do not count. */
ARENA_TEST(layers_that_are_missing_are_known) {
    const Pixel pixels[] = {{0, 1, 100, 4, NONE}, {0, 0.25, 300, 9, NONE}};
    FrameImage frame = row_of(pixels, 2, &arena);
    DisplayLayers layers;
    for (int i = 0; i < frame.channel_count; i++)
        if (!strcmp(frame.channels[i].name, "id.second")) frame.channels[i].name = "id.other";
    assert_false(display_layers_find(&frame, &layers));
    FrameMeasurement m = measure(&frame, "a", arena);
    assert_int_equal(m.rim, RIM_LEFT_OUT);
    assert_int_equal(m.pixels, 1);
    assert_int_equal(m.rim_pixels, 1);
}

TEST_PROGRAM(make_arena, drop_arena)
