/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/fireflies.h"

#include <math.h>

#include "base/mathf.h"

enum { LOOK_REACH = 2, SPREAD_LEAST = 5, SPREAD_MOST = 40, RANK = 3 };

#define LIMIT 2.5f  /* of the RANK-th brightest around */
#define UNSURE 0.7f /* standard error by value */
#define LEAST_RECEIVERS 4.0f /* pixels like it: fewer would become fireflies themselves */
#define FAINT 0.05f /* of the light around: what is added there should be less */

/* The light before anything was moved, so that the order of pixels does not matter. */
typedef struct Before {
    const DenoiseBuffers *buffers;
    float                *mean[3], *luminance;
} Before;

static Before remember(const DenoiseBuffers *b, Arena *arena)
{
    size_t count = (size_t)b->width * (size_t)b->height;
    Before before = {.buffers = b, .luminance = ARENA_NEW(arena, float, count)};
    for (int c = 0; c < 3; c++) before.mean[c] = ARENA_NEW(arena, float, count);
    for (size_t i = 0; i < count; i++) {
        float rgb[3];
        for (int c = 0; c < 3; c++) rgb[c] = before.mean[c][i] = buffers_mean(b, c, i);
        before.luminance[i] = buffers_luminance(rgb);
    }
    return before;
}

/* The RANK-th brightest of the same kind around, 0 when there are fewer. */
static float bright_around(const Before *before, size_t pixel)
{
    const DenoiseBuffers *b = before->buffers;
    PixelWindow           w = buffers_window(b, pixel, LOOK_REACH);
    float                 best[RANK] = {0};
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (i == pixel || b->kind[i] != b->kind[pixel]) continue;
            float value = before->luminance[i];
            for (int k = 0; k < RANK; k++)
                if (value > best[k]) {
                    float lower = best[k];
                    best[k] = value;
                    value = lower;
                }
        }
    return best[RANK - 1];
}

static float standard_error(const DenoiseBuffers *b, size_t pixel)
{
    float sigma[3];
    for (int c = 0; c < 3; c++) sigma[c] = sqrtf(b->variance[c][pixel]);
    return buffers_luminance(sigma);
}

/* Where a pixel's excess goes. */
typedef struct Receivers {
    int   reach;
    float factors[3];  /* weights times factors, summed up */
    float weight, luminance; /* weights, and weights times luminance, summed up */
} Receivers;

/* 0 for the pixel itself and those of another kind. */
static float share_of(const DenoiseBuffers *b, size_t pixel, size_t i)
{
    if (i == pixel || b->kind[i] != b->kind[pixel]) return 0;
    return buffers_likeness(b, pixel, i);
}

static Receivers receivers_within(const Before *before, size_t pixel, int reach)
{
    const DenoiseBuffers *b = before->buffers;
    PixelWindow           w = buffers_window(b, pixel, reach);
    Receivers             r = {.reach = reach};
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            float  share = share_of(b, pixel, i);
            for (int c = 0; c < 3; c++) r.factors[c] += share * b->factor[c][i];
            r.weight += share;
            r.luminance += share * before->luminance[i];
        }
    return r;
}

/* The farther the more there is to spread: a pixel that is a thousand times too bright would
 * be seen as a bright square. */
static Receivers choose_receivers(const Before *before, size_t pixel, float excess)
{
    Receivers r = receivers_within(before, pixel, SPREAD_LEAST);
    while (r.reach < SPREAD_MOST && !(excess <= FAINT * r.luminance))
        r = receivers_within(before, pixel, 2 * r.reach);
    return r;
}

static void add_around(DenoiseBuffers *b, size_t pixel, int reach, const float light[3])
{
    PixelWindow w = buffers_window(b, pixel, reach);
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            float  share = share_of(b, pixel, i);
            for (int k = 0; k < 2; k++)
                for (int c = 0; c < 3; c++) b->light[k][c][i] += share * light[c];
        }
}

/* kept: what share of the pixel's light stays with it. */
static bool spread_pixel(const Before *before, DenoiseBuffers *b, size_t pixel, float kept)
{
    float     excess[3];
    Receivers r = choose_receivers(before, pixel, (1 - kept) * before->luminance[pixel]);
    if (!(r.weight > LEAST_RECEIVERS)) return false;
    for (int c = 0; c < 3; c++) {
        float light = (1 - kept) * before->mean[c][pixel];
        for (int k = 0; k < 2; k++) b->light[k][c][pixel] -= light;
        b->variance[c][pixel] *= kept * kept;
        excess[c] = light * b->factor[c][pixel] / r.factors[c];
    }
    add_around(b, pixel, r.reach, excess);
    return true;
}

long fireflies_spread(DenoiseBuffers *b, Arena scratch)
{
    Before before = remember(b, &scratch);
    long   count = 0;
    for (size_t i = 0; i < (size_t)b->width * (size_t)b->height; i++) {
        float light = before.luminance[i];
        if (b->kind[i] == PIXEL_LEFT || !(light > 0) ||
            !(standard_error(b, i) > UNSURE * light))
            continue;
        float limit = LIMIT * bright_around(&before, i);
        if (light > limit) count += spread_pixel(&before, b, i, limit / light);
    }
    return count;
}
