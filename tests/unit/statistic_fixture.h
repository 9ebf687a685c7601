/* SPDX-License-Identifier: Apache-2.0 */
/* statistic_fixture.h -- frames of known noise for the statistical test.
 *
 * Memory   frames come from the arena that is passed in.
 */
#pragma once
#include "fixture.h"

#include "base/sampler.h"
#include "compare/statistic/statistic.h"

#define WIDTH 48
#define HEIGHT 32
#define PIXELS (WIDTH * HEIGHT)

/* ---- frames of known noise --------------------------------------------------------------- */

typedef struct Random {
    uint32_t state;
} Random;

static inline double unit(Random *random) {
    random->state = hash_u32(random->state + 0x9e3779b9u);
    return ((double)random->state + 0.5) * 0x1p-32;
}

/* All of mean 1. */
typedef enum Noise { NOISE_GAUSSIAN, NOISE_EXPONENTIAL, NOISE_FIREFLIES, NOISE_QUIET } Noise;

static inline double sample_of(Noise noise, Random *random) {
    switch (noise) {
    case NOISE_GAUSSIAN: /* sigma 0.5: nearly so, the sum of three uniform numbers */
        return unit(random) + unit(random) + unit(random) - 0.5;
    case NOISE_EXPONENTIAL: return -log(unit(random));
    case NOISE_FIREFLIES: return 0.8 + (unit(random) < 1e-3 ? 200 : 0);
    default: return 0.9 + 0.2 * unit(random);
    }
}

typedef struct Maker {
    Noise noise;
    int samples;
    uint32_t seed;
    double light[PIXELS]; /* that the mean of a pixel's samples is multiplied by */
} Maker;

/* Light from 0.1 to 1000 cd m^-2, steps at edges, a black corner. */
static inline void plain_scene(Maker *maker) {
    for (int i = 0; i < PIXELS; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        maker->light[i] =
            x < 6 && y < 6 ? 0 : (y > 20 ? 30 : 1) * (x > 30 ? 7 : 0.4) + (x == 10 ? 1000 : 0);
    }
}

/* Of that scene. */
static inline Maker plain_maker(Noise noise, int samples, uint32_t seed) {
    Maker maker = {.noise = noise, .samples = samples, .seed = seed};
    plain_scene(&maker);
    return maker;
}

/* The block of 8 x 8 pixels that begins there. */
static inline void brighten_block(Maker *maker, int x0, int y0, double factor) {
    for (int y = y0; y < y0 + 8; y++)
        for (int x = x0; x < x0 + 8; x++) maker->light[y * WIDTH + x] *= factor;
}

static inline float *plane(FrameImage *frame, const char *layer, char letter, Arena *arena) {
    char name[64];
    snprintf(name, sizeof name, "%s%s%c", layer, layer[0] ? "." : "", letter);
    return frame_add_channel(frame, name, false, arena);
}

/* The mean of one pixel's samples, its variance, and half the difference of two halves. */
static inline void draw_pixel(const Maker *maker, Random *random, double out[3]) {
    double sum = 0, squares = 0, halves = 0, n = maker->samples;
    for (int s = 0; s < maker->samples; s++) {
        double value = sample_of(maker->noise, random);
        sum += value;
        squares += value * value;
        halves += s % 2 ? value : -value;
    }
    out[0] = sum / n;
    out[1] = n > 1 ? fmax(squares - sum * sum / n, 0) / (n - 1) / n : (double)NAN;
    out[2] = halves / n;
}

/* Grey noise on a colour, as the program's is; a display covers x < 24. */
static inline FrameImage make_frame(const Maker *maker, Arena *arena) {
    static const double COLOUR[3] = {1, 0.8, 0.5};
    ExrWindow window = {0, 0, WIDTH, HEIGHT};
    FrameImage frame = frame_create(WIDTH, HEIGHT, window, 24, 8, arena);
    float *light[3], *variance[3], *halves[3], *reflected[3];
    Random random = {hash_u32(maker->seed)};
    for (int c = 0; c < 3; c++) {
        light[c] = plane(&frame, "", "RGB"[c], arena);
        variance[c] = plane(&frame, "variance", "RGB"[c], arena);
        halves[c] = plane(&frame, "halves", "RGB"[c], arena);
        reflected[c] = plane(&frame, "display.reflected", "RGB"[c], arena);
    }
    float *samples = frame_add_channel(&frame, "samples.N", true, arena);
    float *display = frame_add_channel(&frame, "id.display", true, arena);
    for (int i = 0; i < PIXELS; i++) {
        double drawn[3];
        draw_pixel(maker, &random, drawn);
        display[i] = i % WIDTH < 24 ? 4 : -1;
        samples[i] = (float)maker->samples;
        for (int c = 0; c < 3; c++) {
            double scale = maker->light[i] * COLOUR[c];
            light[c][i] = (float)(scale * drawn[0]);
            variance[c][i] = (float)(scale * scale * drawn[1]);
            halves[c][i] = (float)(scale * drawn[2]);
            reflected[c][i] = i % WIDTH < 24 ? light[c][i] : NAN;
        }
    }
    frame_set_string(&frame, "parhelion:display.4", "cluster", arena);
    return frame;
}

static inline void without(FrameImage *frame, const char *layer) {
    int kept = 0;
    for (int i = 0; i < frame->channel_count; i++)
        if (strncmp(frame->channels[i].name, layer, strlen(layer)) != 0)
            frame->channels[kept++] = frame->channels[i];
    frame->channel_count = kept;
}

static inline StatisticResult judge(const FrameImage *reference, const FrameImage *test,
                                    PixelMask mask, Arena *arena) {
    StatisticOptions options = {.mask = mask, .reference_name = "a.exr", .test_name = "b.exr"};
    StatisticResult result;
    assert_done(statistic_compare(reference, test, &options, arena, &result, &err));
    return result;
}

static inline StatisticResult judge_makers(const Maker *reference, const Maker *test,
                                           Arena *arena) {
    FrameImage a = make_frame(reference, arena), b = make_frame(test, arena);
    return judge(&a, &b, NULL, arena);
}

/* The k-th pair of them, each of a seed that no other has. */
static inline StatisticResult judge_pair(Maker *reference, Maker *test, uint32_t k, Arena scratch) {
    reference->seed = 2 * k;
    test->seed = 2 * k + 1;
    return judge_makers(reference, test, &scratch);
}
