/* SPDX-License-Identifier: Apache-2.0 */
/* Luminance and colour of a part of a frame, and their intervals. */
#include "frame_fixture.h"

#include "base/confidence.h"
#include "measure/light_shares.h"

static FrameMeasurement measure(const FrameImage *frame, MeasureRequest request, Arena arena) {
    FrameMeasurement m;
    request.frame_name = "f.exr";
    assert_done(measure_frame(frame, &request, arena, &m, &err));
    return m;
}

static void add_layer(FrameImage *frame, const char *layer, float value, Arena *arena) {
    for (int c = 0; c < 3; c++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%c", layer, "RGB"[c]);
        float *plane = frame_add_channel(frame, name, false, arena);
        for (size_t i = 0; i < frame_pixel_count(frame); i++) plane[i] = value;
    }
}

static void add_plane(FrameImage *frame, const char *name, float value, Arena *arena) {
    float *plane = frame_add_channel(frame, name, false, arena);
    for (size_t i = 0; i < frame_pixel_count(frame); i++) plane[i] = value;
}

static float *plane_of(FrameImage *frame, const char *layer, int channel) {
    char name[64];
    snprintf(name, sizeof name, "%s.%c", layer, "RGB"[channel]);
    for (int c = 0; c < frame->channel_count; c++)
        if (!strcmp(frame->channels[c].name, name)) return frame->channels[c].values;
    fail_msg("no channel %s", name);
    return NULL;
}

/* A display of 10 x 10 pixels: 400 cd m^-2 in white, 20 reflected. */
static FrameImage display_frame(float variance, float black, Arena *arena) {
    FrameImage frame = uniform_frame(10, 10, 100, arena);
    add_layer(&frame, "variance", variance, arena);
    add_layer(&frame, "display.white", 400, arena);
    add_layer(&frame, "display.black", black, arena);
    add_layer(&frame, "display.reflected", 20, arena);
    return frame;
}

static double half(Measured figure) {
    return measured_half_width(figure);
}

static void assert_interval(Measured figure, double low, double high) {
    assert_close(figure.low, low, 1e-5);
    assert_close(figure.high, high, 1e-5);
}

ARENA_TEST(a_region_has_the_mean_of_its_pixels) {
    FrameImage frame = uniform_frame(10, 10, 100, &arena);
    for (int c = 0; c < 3; c++) frame.channels[c].values[0] = 500;
    MeasureRequest corner = {.has_region = true, .region = {0, 0, 2, 2}};
    FrameMeasurement m = measure(&frame, corner, arena);
    assert_int_equal(m.pixels, 4);
    assert_close(m.luminance.value, 200, 1e-5);
    assert_close(m.least, 100, 1e-5);
    assert_close(m.greatest, 500, 1e-5);
    assert_near(m.x.value, 0.3127, 2e-4);
    assert_near(m.y.value, 0.3290, 2e-4);
    assert_near(m.u.value, 0.1978, 3e-4);
    assert_near(m.v.value, 0.4683, 3e-4);
    assert_true(isnan(half(m.luminance)) && !m.has_variance && !m.has_contrast);
    frame.channels[1].values[1] = NAN;
    m = measure(&frame, corner, arena);
    assert_int_equal(m.pixels, 3);
    assert_int_equal(m.nonfinite, 1);
}

/* Half of bright_missing of 100 pixels alike, whose means have this error. */
static double half_missing(double error) {
    return 0.5 * (1 + 14.0 / 100) * error / 100;
}

/* 100 pixels whose means have a variance of 4 each: 1.96 * 2 / sqrt(100). */
ARENA_TEST(intervals_follow_from_the_variance_layer) {
    FrameImage frame = uniform_frame(10, 10, 100, &arena);
    add_layer(&frame, "variance", 4, &arena);
    FrameMeasurement m = measure(&frame, (MeasureRequest){0}, arena);
    assert_close(half(m.luminance), 1.959964 * 0.2 + half_missing(2), 1e-4);
    assert_close(m.luminance.low, 100 - 1.959964 * 0.2, 1e-5);
    assert_true(half(m.x) > 0 && half(m.x) < 0.01);
}

/* With channels that are independent and normal the interval of x holds 95 of 100 times. */
ARENA_TEST(the_interval_of_chromaticity_covers) {
    enum { TRIALS = 2000 };
    unsigned seed = 7;
    int inside = 0;
    double truth = 0;
    for (int trial = -1; trial < TRIALS; trial++) {
        Arena scratch = arena;
        FrameImage frame = uniform_frame(1, 1, 100, &scratch);
        add_layer(&frame, "variance", 4, &scratch);
        for (int c = 0; c < 3; c++) {
            double sum = -6; /* twelve uniform numbers make a normal one */
            for (int k = 0; k < 12; k++) {
                seed = seed * 1664525u + 1013904223u;
                sum += (double)(seed >> 8) / (1 << 24);
            }
            if (trial >= 0) frame.channels[c].values[0] += (float)(2 * sum);
        }
        FrameMeasurement m = measure(&frame, (MeasureRequest){0}, scratch);
        if (trial < 0) truth = m.x.value;
        else inside += fabs(m.x.value - truth) <= half(m.x);
    }
    assert_near(inside / (double)TRIALS, 0.95, 0.02);
}

ARENA_TEST(a_display_has_its_contrast) {
    FrameImage frame = display_frame(4, 0.4f, &arena);
    add_layer(&frame, "display.emitted", 80, &arena);
    add_layer(&frame, "display.mirror", 5, &arena);
    add_layer(&frame, "display.lambertian", 9, &arena);
    float *id = frame_add_channel(&frame, "id.display", true, &arena);
    for (int i = 0; i < 100; i++) id[i] = i < 50 ? 1 : i < 60 ? 0 : -1;
    frame_set_string(&frame, "parhelion:display.0", "centre", &arena);
    frame_set_string(&frame, "parhelion:display.1", "cluster", &arena);
    FrameMeasurement m = measure(&frame, (MeasureRequest){.display = "cluster"}, arena);
    assert_int_equal(m.pixels, 50);
    assert_true(m.has_contrast);
    assert_close(m.contrast.value, 420 / 20.4, 1e-5);
    double w = 1.959964 * 2 / sqrt(50); /* of what is reflected */
    assert_interval(m.contrast, (420 + w) / (20.4 + w), (420 - w) / (20.4 - w));
    assert_close(m.mirror, 5, 1e-5);
    assert_close(m.lambertian, 9, 1e-5);
    assert_close(m.shown, 80, 1e-5);
    m = measure(&frame, (MeasureRequest){.display = "centre"}, arena);
    assert_int_equal(m.pixels, 10);
}

/* Of the light, not of the pixels: half of them reflect 20 cd/m2, half 60, of which 0.1 and 0.5
 * by directions that were not measured. */
ARENA_TEST(a_display_states_what_was_not_measured) {
    FrameImage frame = display_frame(4, 0.4f, &arena);
    for (int c = 0; c < 3; c++)
        for (int i = 50; i < 100; i++) plane_of(&frame, "display.reflected", c)[i] = 60;
    FrameMeasurement without = measure(&frame, (MeasureRequest){0}, arena);
    assert_true(isnan(without.extrapolated_reflected) && isnan(without.extrapolated_shown));
    add_plane(&frame, "display.extrapolated.emitted", 1, &arena);
    add_plane(&frame, "display.extrapolated.reflected", 0.1f, &arena);
    float *share = frame.channels[frame.channel_count - 1].values;
    for (int i = 50; i < 100; i++) share[i] = 0.5f;
    FrameMeasurement m = measure(&frame, (MeasureRequest){0}, arena);
    assert_close(m.extrapolated_reflected, (0.1 * 20 + 0.5 * 60) / 80, 1e-6);
    assert_true(isnan(m.extrapolated_shown)); /* what is shown is not in the frame */
    add_layer(&frame, "display.emitted", 0, &arena);
    assert_near(measure(&frame, (MeasureRequest){0}, arena).extrapolated_shown, 0, 0);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 20; i++) plane_of(&frame, "display.emitted", c)[i] = 80;
    m = measure(&frame, (MeasureRequest){0, true, {0, 0, 10, 5}, NULL}, arena);
    assert_close(m.extrapolated_reflected, 0.1, 1e-6);
    assert_close(m.extrapolated_shown, 1, 1e-6);
}

/* A contrast hangs on what is reflected alone: its halves count, not those of the pixel, which
 * differ by what the display emits, too. */
ARENA_TEST(a_contrast_has_the_noise_of_the_reflected) {
    FrameImage frame = display_frame(4, 0.4f, &arena);
    add_layer(&frame, "halves", 2, &arena);
    FrameMeasurement whole = measure(&frame, (MeasureRequest){0}, arena);
    add_layer(&frame, "display.halves", 0.5f, &arena);
    FrameMeasurement m = measure(&frame, (MeasureRequest){0}, arena);
    double below = student_quantile(300) * 0.5 / 10;
    double above = below + (1 + 14.0 / 100) * 0.5 / 100; /* bright_missing of 100 alike */
    assert_close(half(m.luminance), half(whole.luminance), 1e-9);
    assert_interval(m.contrast, (420 + above) / (20.4 + above), (420 - below) / (20.4 - below));
}

/* A pixel that shows a display alone has the noise of what is reflected, and of what is shown:
 * that by its samples stands 0.3 from that by finer rays. Others have their halves'. */
ARENA_TEST(what_a_display_shows_is_known_twice) {
    for (int k = 0; k < 4; k++) {
        FrameImage frame = display_frame(4, 0.4f, &arena);
        add_layer(&frame, "halves", 2, &arena);
        add_layer(&frame, "display.halves", 0.4f, &arena);
        add_layer(&frame, "display.emitted", k == 3 ? NAN : 80, &arena);
        add_layer(&frame, "display.fine", k == 1 ? NAN : 79.7f, &arena);
        add_plane(&frame, "display.coverage", k == 2 ? 0.99f : 1, &arena);
        FrameMeasurement m = measure(&frame, (MeasureRequest){0}, arena);
        double error = k ? 2 : 0.5, spread = student_quantile(300) * error / 10;
        assert_close(half(m.luminance), spread + half_missing(error), 1e-4);
    }
}

/* Where less than nothing might be reflected the lower end is nothing: of a display whose black
 * is dark no contrast is too great. */
ARENA_TEST(noise_beyond_the_reflected_leaves_no_upper_end) {
    for (int k = 0; k < 2; k++) {
        FrameImage frame = display_frame(100 * 200 * 200, k ? 0 : 0.4f, &arena);
        FrameMeasurement m = measure(&frame, (MeasureRequest){0}, arena);
        double above = 20 + 1.959964 * 200, black = k ? 0 : (double)0.4f;
        assert_close(m.contrast.value, 420 / (20 + black), 1e-5);
        assert_close(m.contrast.low, (400 + above) / (black + above), 1e-5);
        if (k) assert_true(isinf(m.contrast.high));
        else assert_close(m.contrast.high, 400 / black, 1e-5);
    }
}

ARENA_TEST(what_cannot_be_measured_is_told) {
    FrameImage frame = uniform_frame(10, 10, 100, &arena);
    MeasureRequest request = {"f.exr", true, {5, 5, 11, 8}, NULL};
    FrameMeasurement m;
    assert_fails_as(measure_frame(&frame, &request, arena, &m, &err), ERROR_USAGE,
                    "inside the frame's pixels 0,0,10,10");
    frame_set_string(&frame, "parhelion:display.1", "cluster", &arena);
    request = (MeasureRequest){.frame_name = "f.exr", .display = "claster"};
    assert_fails_as(measure_frame(&frame, &request, arena, &m, &err), ERROR_USAGE,
                    "its displays: cluster");
    request.display = "cluster";
    assert_fails_as(measure_frame(&frame, &request, arena, &m, &err), ERROR_INPUT, "--layers id");
    float *id = frame_add_channel(&frame, "id.display", true, &arena);
    for (int i = 0; i < 100; i++) id[i] = -1;
    assert_fails_as(measure_frame(&frame, &request, arena, &m, &err), ERROR_INPUT,
                    "no pixel to measure on display cluster");
}

static double uniform(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return ((double)(*seed >> 8) + 0.5) / (1 << 24);
}

static double normal(unsigned *seed) {
    double radius = sqrt(-2 * log(uniform(seed)));
    return radius * cos(6.283185307179586 * uniform(seed));
}

static int poisson(double mean, unsigned *seed) {
    int count = 0;
    double least = exp(-mean);
    for (double product = uniform(seed); product > least; product *= uniform(seed)) count++;
    return count;
}

#define GLINT 5.0 /* cd m^-2 that one bright sample adds to its pixel */

/* What each half of a pixel's samples found besides 20 cd m^-2: noise, and `glints` in all. */
static void scatter_glints(FrameImage *frame, double glints, unsigned *seed) {
    size_t pixels = frame_pixel_count(frame);
    float *reflected[3], *halves[3];
    for (int c = 0; c < 3; c++) {
        reflected[c] = plane_of(frame, "display.reflected", c);
        halves[c] = plane_of(frame, "display.halves", c);
    }
    for (size_t i = 0; i < pixels; i++) {
        double part[2];
        for (int k = 0; k < 2; k++)
            part[k] = GLINT * poisson(0.5 * glints / (double)pixels, seed) + 0.1 * normal(seed);
        for (int c = 0; c < 3; c++) {
            reflected[c][i] = (float)(20 + part[0] + part[1]);
            halves[c][i] = (float)(part[0] - part[1]);
        }
    }
}

/* Of a few bright samples, as of many: the interval of a contrast holds the true one. */
ARENA_TEST(the_interval_of_contrast_covers_glints) {
    enum { TRIALS = 2000 };
    static const double glints[] = {0, 4, 10, 40, 400};
    unsigned seed = 11;
    FrameImage frame = display_frame(100, 0.4f, &arena);
    add_layer(&frame, "display.halves", 0, &arena);
    for (size_t k = 0; k < sizeof glints / sizeof *glints; k++) {
        double reflected = 20 + GLINT * glints[k] / 100;
        double truth = (400 + reflected) / (0.4 + reflected);
        int inside = 0;
        for (int trial = 0; trial < TRIALS; trial++) {
            scatter_glints(&frame, glints[k], &seed);
            Measured m = measure(&frame, (MeasureRequest){0}, arena).contrast;
            inside += m.low <= truth && truth <= m.high;
        }
        double held = inside / (double)TRIALS;
        assert_true(held > 0.935);
        if (k == 0 || glints[k] > 100) assert_near(held, 0.955, 0.02); /* not too long */
    }
}

/* The same of the luminance: without what may be missing, 88 % of four. */
ARENA_TEST(the_interval_of_luminance_covers_glints) {
    enum { TRIALS = 2000 };
    static const double glints[] = {0, 4, 6, 10, 40, 400};
    unsigned seed = 12;
    FrameImage frame = display_frame(0, 0.4f, &arena);
    add_layer(&frame, "halves", 0, &arena);
    add_layer(&frame, "display.halves", 0, &arena);
    for (size_t k = 0; k < sizeof glints / sizeof *glints; k++) {
        double truth = 20 + GLINT * glints[k] / 100;
        int inside = 0;
        for (int trial = 0; trial < TRIALS; trial++) {
            scatter_glints(&frame, glints[k], &seed);
            for (size_t i = 0; i < frame_pixel_count(&frame); i++)
                for (int c = 0; c < 3; c++) {
                    float half = plane_of(&frame, "display.halves", c)[i];
                    frame.channels[c].values[i] = plane_of(&frame, "display.reflected", c)[i];
                    plane_of(&frame, "halves", c)[i] = half;
                    plane_of(&frame, "variance", c)[i] = half * half;
                }
            Measured m = measure(&frame, (MeasureRequest){0}, arena).luminance;
            inside += m.low <= truth && truth <= m.high;
        }
        double held = inside / (double)TRIALS;
        if (k == 0 || glints[k] > 100) assert_near(held, 0.955, 0.02); /* not too long */
        if (!(held > 0.935)) fail_msg("%g glints: %g", glints[k], held);
    }
}

/* Samples that fill each other's gaps: their halves lie three times as far apart as their mean
 * from what is true, and finer rays a third as far. */
ARENA_TEST(the_interval_of_a_displays_luminance_covers) {
    enum { TRIALS = 2000 };
    unsigned seed = 19;
    int inside = 0;
    FrameImage frame = display_frame(4, 0.4f, &arena);
    add_layer(&frame, "halves", 0, &arena);
    add_layer(&frame, "display.halves", 0, &arena);
    add_layer(&frame, "display.emitted", 0, &arena);
    add_layer(&frame, "display.fine", 0, &arena);
    add_plane(&frame, "display.coverage", 1, &arena);
    for (int trial = 0; trial < TRIALS; trial++) {
        for (size_t i = 0; i < frame_pixel_count(&frame); i++) {
            double shown = normal(&seed), fine = normal(&seed) / 3, reflected = normal(&seed);
            double half = 3 * normal(&seed), reflected_half = normal(&seed);
            for (int c = 0; c < 3; c++) {
                frame.channels[c].values[i] = (float)(100 + shown + reflected);
                plane_of(&frame, "display.emitted", c)[i] = (float)(80 + shown);
                plane_of(&frame, "display.fine", c)[i] = (float)(80 + fine);
                plane_of(&frame, "display.halves", c)[i] = (float)reflected_half;
                plane_of(&frame, "halves", c)[i] = (float)(half + reflected_half);
            }
        }
        Measured m = measure(&frame, (MeasureRequest){0}, arena).luminance;
        inside += m.low <= 100 && 100 <= m.high;
    }
    assert_near(inside / (double)TRIALS, 0.958, 0.015);
}

/* The brightest first, whatever order they stand in; those without a measure behind them. */
ARENA_TEST(lights_are_told_by_their_brightness) {
    static const char *const names[] = {"light.a", "light.b", "light.c", "light.d", "light.e"};
    const float light[] = {10, NAN, 30, NAN, 20};
    static const char *const wanted[] = {"light.c", "light.e", "light.a", "light.b", "light.d"};
    FrameImage frame = uniform_frame(4, 4, 60, &arena);
    MeasureRequest all = {.frame_name = "f.exr"};
    for (int i = 0; i < 5; i++) add_layer(&frame, names[i], light[i], &arena);
    LightShares shares = light_shares_measure(&frame, &all, 60, &arena);
    assert_int_equal(shares.count, 5);
    for (int i = 0; i < 5; i++) assert_string_equal(shares.list[i].layer, wanted[i]);
    assert_close(shares.list[0].share, 0.5, 1e-5);
    assert_true(isnan(shares.list[3].cd_m2));
}

TEST_PROGRAM(make_arena, drop_arena)
