/* SPDX-License-Identifier: Apache-2.0 */
/* The preview's filter: what it must leave alone, what it must take away, and that no light is
 * lost on the way. */
#include "fixture.h"

#include "denoise/denoise.h"
#include "denoise/feature_weights.h"
#include "denoise/regression.h"

enum { WIDTH = 70, HEIGHT = 50, COUNT = WIDTH * HEIGHT, SAMPLES = 24 };

/* ---- frames ------------------------------------------------------------------------------ */

static float *plane(FrameImage *frame, const char *layer, char letter, Arena *arena)
{
    char name[64];
    snprintf(name, sizeof name, "%s%s%c", layer, *layer ? "." : "", letter);
    const float *found = frame_channel(frame, name);
    return found ? (float *)(uintptr_t)found : frame_add_channel(frame, name, false, arena);
}

static void set(FrameImage *frame, const char *layer, const char *letters, float value,
                Arena *arena)
{
    for (; *letters; letters++) {
        float *values = plane(frame, layer, *letters, arena);
        for (size_t i = 0; i < frame_pixel_count(frame); i++) values[i] = value;
    }
}

/* A grey wall of 100 cd/m2 that faces the eye: no noise, no display. */
static FrameImage wall(int width, int height, ExrWindow data, Arena *arena)
{
    FrameImage frame = frame_create(width, height, data, 32, 4, arena);
    set(&frame, "", "RGB", 100, arena);
    set(&frame, "variance", "RGB", 0, arena);
    set(&frame, "halves", "RGB", 0, arena);
    set(&frame, "normal", "XY", 0, arena);
    set(&frame, "normal", "Z", 1, arena);
    set(&frame, "albedo", "RGB", 0.5f, arena);
    set(&frame, "depth", "Z", 2, arena);
    set(&frame, "display.emitted", "RGB", NAN, arena);
    set(&frame, "display.reflected", "RGB", NAN, arena);
    frame_set_string(&frame, "parhelion:samples", "0:24", arena);
    return frame;
}

static FrameImage whole_wall(Arena *arena)
{
    return wall(WIDTH, HEIGHT, (ExrWindow){0, 0, WIDTH, HEIGHT}, arena);
}

static double uniform(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) * 0x1p-24;
}

/* Exponentially distributed samples of the given mean, each as noisy as it is bright: the mean
 * of them, its variance and its halves as the film has them. */
static void add_noise(FrameImage *frame, const char *layer, float mean, Arena *arena)
{
    uint32_t state = 7;
    for (const char *c = "RGB"; *c; c++) {
        float *light = plane(frame, "", *c, arena), *part = plane(frame, layer, *c, arena);
        float *variance = plane(frame, "variance", *c, arena);
        float *halves = plane(frame, "halves", *c, arena);
        for (size_t i = 0; i < frame_pixel_count(frame); i++) {
            double sum[2] = {0, 0}, squares = 0;
            for (int k = 0; k < SAMPLES; k++) {
                double value = -log(1 - uniform(&state)) * (double)mean;
                sum[k >= 16] += value;
                squares += value * value;
            }
            double all = (sum[0] + sum[1]) / SAMPLES;
            light[i] += (float)all;
            if (part != light) part[i] = (float)all;
            variance[i] = (float)((squares / SAMPLES - all * all) / (SAMPLES - 1));
            halves[i] = (float)((sum[1] / 8 - sum[0] / 16) * sqrt(8.0 * 16) / SAMPLES);
        }
    }
}

static FrameImage noise(const char *samples, Arena *arena)
{
    FrameImage frame = whole_wall(arena);
    set(&frame, "", "RGB", 0, arena);
    add_noise(&frame, "", 100, arena);
    frame_set_string(&frame, "parhelion:samples", samples, arena);
    return frame;
}

static FrameImage denoised(const FrameImage *frame, int threads, DenoiseReport *report,
                           Arena *arena)
{
    FrameImage out;
    assert_done(denoise_frame(frame, threads, arena, &out, report, &err));
    assert_memory_equal(&out.data, &frame->data, sizeof out.data);
    assert_memory_equal(&out.display, &frame->display, sizeof out.display);
    assert_int_equal(out.channel_count, 3);
    return out;
}

static const float *green(const FrameImage *frame)
{
    return frame_channel(frame, "G");
}

static double variance_of(const float *values, size_t count)
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < count; i++) {
        sum += (double)values[i];
        squares += (double)values[i] * (double)values[i];
    }
    return squares / (double)count - sum * sum / (double)count / (double)count;
}

/* ---- what stays -------------------------------------------------------------------------- */

ARENA_TEST(a_constant_picture_stays_however_noisy_it_is_said_to_be)
{
    DenoiseReport report;
    const float   variances[] = {0, 1, 1e4f};
    for (int k = 0; k < 3; k++) {
        FrameImage frame = whole_wall(&arena);
        set(&frame, "variance", "RGB", variances[k], &arena);
        FrameImage out = denoised(&frame, 2, &report, &arena);
        for (size_t i = 0; i < COUNT; i++) assert_close(green(&out)[i], 100, 1e-5);
        assert_close(report.energy_ratio, 1, 1e-5);
        assert_int_equal(report.fireflies, 0);
    }
}

ARENA_TEST(a_frame_without_noise_stays)
{
    FrameImage    frame = whole_wall(&arena);
    DenoiseReport report;
    uint32_t      random = 3;
    for (const char *c = "RGB"; *c; c++) {
        float *light = plane(&frame, "", *c, &arena);
        float *albedo = plane(&frame, "albedo", *c, &arena);
        for (size_t i = 0; i < COUNT; i++) {
            light[i] = (float)pow(10, 4 * uniform(&random) - 1);
            albedo[i] = (float)uniform(&random);
        }
    }
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i++)
            assert_close(plane(&out, "", *c, &arena)[i], plane(&frame, "", *c, &arena)[i],
                         1e-5);
}

/* A step of light that the halves agree on stays a step. */
ARENA_TEST(a_shadow_s_edge_stays_where_it_is)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i++) {
            if (i % WIDTH >= WIDTH / 2) continue;
            plane(&frame, "", *c, &arena)[i] *= 0.05f;
            plane(&frame, "variance", *c, &arena)[i] *= 0.0025f;
            plane(&frame, "halves", *c, &arena)[i] *= 0.05f;
        }
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (int y = 10; y < HEIGHT - 10; y++) {
        assert_true(green(&out)[y * WIDTH + WIDTH / 2 - 1] < 30);
        assert_true(green(&out)[y * WIDTH + WIDTH / 2] > 60);
    }
}

/* Columns from `first` to `end` of all that add_noise made get `times` as bright. */
static void scale_columns(FrameImage *frame, int first, int end, float times, Arena *arena)
{
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i++) {
            if ((int)(i % WIDTH) < first || (int)(i % WIDTH) >= end) continue;
            plane(frame, "", *c, arena)[i] *= times;
            plane(frame, "variance", *c, arena)[i] *= times * times;
            plane(frame, "halves", *c, arena)[i] *= times;
        }
}

static double mean_of_columns(const float *values, int first, int end)
{
    double sum = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = first; x < end; x++) sum += (double)values[y * WIDTH + x];
    return sum / (end - first) / HEIGHT;
}

/* The left half turns its side: another surface. */
static void turn_left_half(FrameImage *frame, Arena *arena)
{
    for (size_t i = 0; i < COUNT; i++) {
        if (i % WIDTH >= WIDTH / 2) continue;
        plane(frame, "normal", 'X', arena)[i] = 1;
        plane(frame, "normal", 'Z', arena)[i] = 0;
    }
}

ARENA_TEST(a_narrow_shadow_stays_narrow_and_dark)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    scale_columns(&frame, 30, 32, 0.4f, &arena);
    FrameImage out = denoised(&frame, 2, &report, &arena);
    assert_near(mean_of_columns(green(&out), 30, 32), 40, 10);
    assert_near(mean_of_columns(green(&out), 28, 29), 100, 10);
    assert_near(mean_of_columns(green(&out), 33, 34), 100, 10);
}

/* Light that rises with a turning normal, over noise: columns keep their means. */
ARENA_TEST(a_slope_along_a_feature_stays)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    for (int x = 0; x < WIDTH; x++)
        scale_columns(&frame, x, x + 1, 1 + 0.03f * (float)x, &arena);
    for (size_t i = 0; i < COUNT; i++)
        plane(&frame, "normal", 'X', &arena)[i] = 0.01f * (float)(i % WIDTH);
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (int x = 2; x < WIDTH - 2; x++)
        assert_close(mean_of_columns(green(&out), x, x + 1), 100 * (1 + 0.03 * x), 0.05);
}

ARENA_TEST(an_edge_of_albedo_stays_and_no_light_crosses_it)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    scale_columns(&frame, 0, WIDTH / 2, 0.2f, &arena);
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i++)
            if (i % WIDTH < WIDTH / 2) plane(&frame, "albedo", *c, &arena)[i] = 0.1f;
    FrameImage out = denoised(&frame, 2, &report, &arena);
    assert_close(mean_of_columns(green(&out), WIDTH / 2 - 1, WIDTH / 2), 20, 0.08);
    assert_close(mean_of_columns(green(&out), WIDTH / 2, WIDTH / 2 + 1), 100, 0.08);
}

ARENA_TEST(light_stays_on_its_side_of_a_silhouette)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    turn_left_half(&frame, &arena);
    scale_columns(&frame, 0, WIDTH / 2, 50, &arena);
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = WIDTH / 2; x < WIDTH; x++)
            assert_near(green(&out)[y * WIDTH + x], 100, 40);
}

/* ---- what goes --------------------------------------------------------------------------- */

ARENA_TEST(noise_goes_and_light_stays)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    FrameImage    out = denoised(&frame, 2, &report, &arena);
    assert_true(report.has_halves);
    assert_true(variance_of(green(&out), COUNT) < variance_of(green(&frame), COUNT) / 20);
    assert_close(report.energy_ratio, 1, 0.01);
}

/* Samples that say too little of their spread make every patch unlike every other; what the
 * halves say, and the surface, are left to go by. */
ARENA_TEST(noise_goes_where_no_patch_is_like_another)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i++) plane(&frame, "variance", *c, &arena)[i] *= 1e-3f;
    FrameImage out = denoised(&frame, 2, &report, &arena);
    assert_true(variance_of(green(&out), COUNT) < variance_of(green(&frame), COUNT) / 8);
    assert_close(report.energy_ratio, 1, 0.01);
}

ARENA_TEST(few_samples_are_filtered_without_halves)
{
    FrameImage    frame = noise("0:8", &arena);
    DenoiseReport report;
    set(&frame, "halves", "RGB", NAN, &arena);
    FrameImage out = denoised(&frame, 2, &report, &arena);
    assert_false(report.has_halves);
    assert_true(variance_of(green(&out), COUNT) < variance_of(green(&frame), COUNT) / 8);
    assert_close(report.energy_ratio, 1, 0.02);
}

ARENA_TEST(a_firefly_is_spread_and_not_lost)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    const size_t  middle = (size_t)HEIGHT / 2 * WIDTH + WIDTH / 2;
    for (const char *c = "RGB"; *c; c++) { /* one sample of 24, in the second half */
        plane(&frame, "", *c, &arena)[middle] = 50000;
        plane(&frame, "variance", *c, &arena)[middle] = 50000.0f * 50000.0f;
        plane(&frame, "halves", *c, &arena)[middle] = (float)(150000 * sqrt(128.0) / 24);
    }
    FrameImage out = denoised(&frame, 2, &report, &arena);
    assert_true(report.fireflies >= 1 && report.fireflies < COUNT / 100);
    assert_close(report.energy_ratio, 1, 0.02);
    for (size_t i = 0; i < COUNT; i++) assert_true(green(&out)[i] < 1500);
}

ARENA_TEST(a_firefly_s_light_stays_on_its_surface)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    const size_t  near = (size_t)HEIGHT / 2 * WIDTH + WIDTH / 2 - 2;
    turn_left_half(&frame, &arena);
    double before = mean_of_columns(green(&frame), WIDTH / 2, WIDTH);
    for (const char *c = "RGB"; *c; c++) {
        plane(&frame, "", *c, &arena)[near] = 50000;
        plane(&frame, "variance", *c, &arena)[near] = 50000.0f * 50000.0f;
        plane(&frame, "halves", *c, &arena)[near] = (float)(150000 * sqrt(128.0) / 24);
    }
    FrameImage out = denoised(&frame, 2, &report, &arena);
    assert_true(report.fireflies >= 1);
    assert_close(report.energy_ratio, 1, 0.02);
    assert_close(mean_of_columns(green(&out), WIDTH / 2, WIDTH), before, 0.01);
}

/* ---- displays ---------------------------------------------------------------------------- */

/* A display of black and white pixels that reflects noise. */
static FrameImage display(Arena *arena)
{
    FrameImage frame = whole_wall(arena);
    set(&frame, "", "RGB", 0, arena);
    set(&frame, "display.reflected", "RGB", 0, arena);
    add_noise(&frame, "display.reflected", 20, arena);
    for (const char *c = "RGB"; *c; c++) {
        float *light = plane(&frame, "", *c, arena);
        float *emitted = plane(&frame, "display.emitted", *c, arena);
        for (size_t i = 0; i < COUNT; i++) {
            emitted[i] = (i % WIDTH + i / WIDTH) % 2 ? 500 : 0.1f;
            light[i] += emitted[i];
        }
    }
    return frame;
}

ARENA_TEST(what_a_display_shows_stays_sharp_and_what_it_reflects_is_filtered)
{
    FrameImage    frame = display(&arena);
    DenoiseReport report;
    FrameImage    out = denoised(&frame, 2, &report, &arena);
    const float  *emitted = frame_channel(&frame, "display.emitted.G");
    const float  *reflected = frame_channel(&frame, "display.reflected.G");
    float        *rest = ARENA_NEW(&arena, float, COUNT);
    for (size_t i = 0; i < COUNT; i++) {
        rest[i] = green(&out)[i] - emitted[i];
        assert_near(rest[i], 20, 10);
    }
    assert_true(variance_of(rest, COUNT) < variance_of(reflected, COUNT) / 20);
}

/* Edges of content inside pixels spread the samples and part the halves, a hundred times as
 * much as the reflection has light. */
ARENA_TEST(what_a_display_shows_casts_no_glow_on_what_it_reflects)
{
    FrameImage    frame = display(&arena);
    DenoiseReport report;
    uint32_t      random = 5;
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i++) {
            if (i % WIDTH < 20 || i % WIDTH >= 50) continue;
            plane(&frame, "variance", *c, &arena)[i] += 2000.0f * 2000.0f;
            plane(&frame, "halves", *c, &arena)[i] += uniform(&random) < 0.5 ? 2000 : -2000;
        }
    FrameImage   out = denoised(&frame, 2, &report, &arena);
    const float *emitted = frame_channel(&frame, "display.emitted.G");
    float       *rest = ARENA_NEW(&arena, float, COUNT);
    for (size_t i = 0; i < COUNT; i++) rest[i] = green(&out)[i] - emitted[i];
    assert_near(mean_of_columns(rest, 20, 50), 20, 0.4);
    assert_close(report.energy_ratio, 1, 0.002);
}

ARENA_TEST(what_a_display_emits_is_kept_to_the_bit)
{
    FrameImage    frame = display(&arena);
    DenoiseReport report;
    set(&frame, "display.reflected", "RGB", 0, &arena);
    set(&frame, "halves", "RGB", 0, &arena);
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i++)
            plane(&frame, "", *c, &arena)[i] = plane(&frame, "display.emitted", *c, &arena)[i];
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (const char *c = "RGB"; *c; c++)
        assert_memory_equal(plane(&out, "", *c, &arena),
                            plane(&frame, "display.emitted", *c, &arena),
                            COUNT * sizeof(float));
}

/* The sun's edge on a display that reflects little: noise is as large as the light. */
ARENA_TEST(a_shadow_s_edge_on_a_display_stays_sharp)
{
    FrameImage    frame = display(&arena);
    DenoiseReport report;
    const float  *emitted = frame_channel(&frame, "display.emitted.G");
    float        *rest = ARENA_NEW(&arena, float, COUNT);
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i++) {
            if (i % WIDTH >= WIDTH / 2) continue;
            plane(&frame, "", *c, &arena)[i] -=
                0.6f * plane(&frame, "display.reflected", *c, &arena)[i];
            plane(&frame, "display.reflected", *c, &arena)[i] *= 0.4f;
            plane(&frame, "variance", *c, &arena)[i] *= 0.16f;
            plane(&frame, "halves", *c, &arena)[i] *= 0.4f;
        }
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (size_t i = 0; i < COUNT; i++) rest[i] = green(&out)[i] - emitted[i];
    assert_near(mean_of_columns(rest, WIDTH / 2 - 1, WIDTH / 2), 8, 1);
    assert_near(mean_of_columns(rest, WIDTH / 2, WIDTH / 2 + 1), 20, 2); /* 3.4 of its errors */
}

ARENA_TEST(the_edge_of_a_display_is_left_as_it_is)
{
    FrameImage    frame = display(&arena);
    DenoiseReport report;
    for (const char *c = "RGB"; *c; c++)
        for (size_t i = 0; i < COUNT; i += WIDTH) /* half of these pixels is a bezel */
            plane(&frame, "", *c, &arena)[i] = 123 + (float)(i % 7);
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (size_t i = 0; i < COUNT; i += WIDTH)
        assert_true(green(&out)[i] == green(&frame)[i]);
}

/* What the samples place badly, in pixels that a display fills and in those that it covers in
 * part, is not in display.fine; a steady reflection is what is left of them. */
ARENA_TEST(what_few_samples_saw_of_a_display_gives_way_to_more_rays)
{
    FrameImage    frame = display(&arena);
    DenoiseReport report;
    uint32_t      random = 9;
    float *coverage = frame_add_channel(&frame, "display.coverage", false, &arena);
    float *fine[3];
    for (int c = 0; c < 3; c++) {
        fine[c] = frame_add_channel(&frame, arena_format(&arena, "display.fine.%c", "RGB"[c]),
                                    false, &arena);
    }
    for (size_t i = 0; i < COUNT; i++) {
        coverage[i] = i % WIDTH < 30 ? 1 : (float)(8 + i % 16) / 24;
        for (int c = 0; c < 3; c++) {
            float seen = 50 + 400 * (float)uniform(&random);
            plane(&frame, "display.emitted", "RGB"[c], &arena)[i] = seen;
            plane(&frame, "", "RGB"[c], &arena)[i] = seen * coverage[i] + 20;
            plane(&frame, "variance", "RGB"[c], &arena)[i] = 50 * 50;
            plane(&frame, "halves", "RGB"[c], &arena)[i] = uniform(&random) < 0.5 ? 50 : -50;
            fine[c][i] = 100 + 3 * (float)(i % 7);
        }
    }
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (size_t i = 0; i < COUNT; i++) assert_close(green(&out)[i], fine[1][i] + 20, 1e-4);
}

/* ---- weights by features ----------------------------------------------------------------- */

/* Two walls that meet in a corner, one pixel of sky: only the own wall counts, the nearer the
 * more. */
ARENA_TEST(features_part_surfaces)
{
    enum { SIDE = 25, MIDDLE = 12, PIXELS = SIDE * SIDE, SELF = PATCH_OFFSETS / 2 };
    float          weights[PATCH_OFFSETS];
    DenoiseBuffers b = {.width = SIDE, .height = SIDE,
                        .rows = ARENA_NEW(&arena, BufferRow, PIXELS),
                        .kind = ARENA_NEW(&arena, unsigned char, PIXELS)};
    for (int i = 0; i < PIXELS; i++) {
        b.kind[i] = PIXEL_SURFACE;
        b.rows[i][ROW_NORMAL] = i % SIDE < MIDDLE ? 1 : 0;
    }
    b.kind[MIDDLE * SIDE + MIDDLE + 1] = PIXEL_VOID;
    feature_weights(&b, MIDDLE, MIDDLE, weights);
    assert_near(weights[SELF], 1, 1e-5);
    assert_true(weights[SELF - 1] == 0);
    assert_true(weights[SELF + 1] == 0);
    assert_true(weights[SELF + 2] > weights[SELF + 3] && weights[SELF + 3] > 0);
    assert_near(weights[SELF + PATCH_WINDOW], weights[SELF - PATCH_WINDOW], 1e-6);
    feature_weights(&b, SIDE - 1, 0, weights);
    assert_true(weights[SELF + 1] == 0 && weights[SELF - PATCH_WINDOW] == 0);
    assert_true(weights[SELF - 1] > 0.9f);
}

/* ---- the fit ----------------------------------------------------------------------------- */

/* Light that is linear in features, which go together, and in the place: a window of equal
 * weights gives it back but for what the ridge takes. */
ARENA_TEST(linear_light_is_fitted)
{
    enum { SIDE = 9, PIXELS = SIDE * SIDE };
    uint32_t random = 4;
    float    weights[PIXELS];
    DenoiseBuffers b = {.width = SIDE, .height = SIDE,
                        .rows = ARENA_NEW(&arena, BufferRow, PIXELS)};
    RegressionWindow window = {&b, SIDE / 2, SIDE / 2, SIDE / 2, weights};
    RegressionSums   sums = {.weight = ARENA_NEW(&arena, float, PIXELS)};
    for (int c = 0; c < 3; c++) {
        b.light[1][c] = ARENA_NEW(&arena, float, PIXELS);
        sums.light[c] = ARENA_NEW(&arena, float, PIXELS);
    }
    for (int i = 0; i < PIXELS; i++) {
        float tilt = (float)uniform(&random), albedo = 0.7f * tilt + (float)uniform(&random);
        weights[i] = 0.5f;
        b.rows[i][ROW_NORMAL] = tilt;
        b.rows[i][ROW_ALBEDO + 1] = albedo;
        for (int c = 0; c < 3; c++) {
            float light = 5 + 4 * tilt - (float)c * albedo + 0.3f * (float)(i % SIDE);
            b.rows[i][ROW_LIGHT + 3 + c] = b.light[1][c][i] = light;
        }
    }
    regression_add(&window, 1, &sums);
    for (int i = 0; i < PIXELS; i++) {
        assert_near(sums.weight[i], 0.5, 0);
        for (int c = 0; c < 3; c++)
            assert_near(sums.light[c][i], 0.5f * b.light[1][c][i], 0.05);
    }
}

/* ---- any frame --------------------------------------------------------------------------- */

ARENA_TEST(any_number_of_threads_makes_the_same_bits)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    FrameImage    one = denoised(&frame, 1, &report, &arena);
    for (int threads = 2; threads < 6; threads += 3) {
        FrameImage more = denoised(&frame, threads, &report, &arena);
        for (const char *c = "RGB"; *c; c++)
            assert_memory_equal(plane(&one, "", *c, &arena), plane(&more, "", *c, &arena),
                                COUNT * sizeof(float));
    }
}

ARENA_TEST(a_pixel_that_is_not_finite_harms_no_other)
{
    FrameImage    frame = noise("0:24", &arena);
    DenoiseReport report;
    const size_t  bad[] = {0, 5 * WIDTH + 9, 20 * WIDTH + 33, COUNT - 1};
    const float   values[] = {NAN, INFINITY, -INFINITY, NAN};
    for (int k = 0; k < 4; k++) plane(&frame, "", 'G', &arena)[bad[k]] = values[k];
    plane(&frame, "variance", 'R', &arena)[100] = NAN;
    plane(&frame, "halves", 'B', &arena)[200] = INFINITY;
    plane(&frame, "normal", 'X', &arena)[300] = NAN;
    plane(&frame, "albedo", 'G', &arena)[400] = INFINITY;
    plane(&frame, "depth", 'Z', &arena)[500] = INFINITY;
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (int k = 0; k < 4; k++)
        assert_memory_equal(&green(&out)[bad[k]], &values[k], sizeof values[k]);
    for (size_t i = 0, k = 0; i < COUNT; i++) {
        if (k < 4 && i == bad[k]) k++;
        else assert_near(green(&out)[i], 100, 90);
    }
    assert_close(report.energy_ratio, 1, 0.02);
}

ARENA_TEST(small_frames_and_crops_are_filtered)
{
    DenoiseReport   report;
    const ExrWindow windows[] = {{0, 0, 1, 1}, {0, 0, 1, 40}, {3, 2, 40, 3}, {30, 20, 66, 49},
                                 {-5, -5, 30, 30}};
    for (int k = 0; k < 5; k++) {
        FrameImage frame = wall(WIDTH, HEIGHT, windows[k], &arena);
        set(&frame, "variance", "RGB", 4, &arena);
        FrameImage out = denoised(&frame, 2, &report, &arena);
        for (size_t i = 0; i < frame_pixel_count(&frame); i++)
            assert_close(green(&out)[i], 100, 1e-5);
    }
}

ARENA_TEST(black_stays_black)
{
    FrameImage    frame = whole_wall(&arena);
    DenoiseReport report;
    set(&frame, "", "RGB", 0, &arena);
    set(&frame, "albedo", "RGB", 0, &arena);
    FrameImage out = denoised(&frame, 2, &report, &arena);
    for (size_t i = 0; i < COUNT; i++) assert_true(green(&out)[i] == 0);
    assert_true(report.energy_ratio == 1);
}

ARENA_TEST(missing_layers_are_named)
{
    FrameImage    frame = frame_create(2, 2, (ExrWindow){0, 0, 2, 2}, 8, 0, &arena), out;
    DenoiseReport report;
    Error         err = {0};
    set(&frame, "", "RGB", 1, &arena);
    set(&frame, "variance", "RGB", 1, &arena);
    set(&frame, "depth", "Z", 1, &arena);
    assert_false(denoise_frame(&frame, 1, &arena, &out, &report, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_string_equal(err.text,
                        "has not what --denoise goes by (missing: halves, normal, albedo, "
                        "display.emitted, display.reflected) — render it with --layers "
                        DENOISE_LAYERS);
}

TEST_PROGRAM(make_arena, drop_arena)
