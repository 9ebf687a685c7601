#include "denoise/fireflies.h"

#include <math.h>
#include <string.h>

enum { LOOK_REACH = 2, SPREAD_REACH = 5, RANK = 3 };

#define LIMIT 4.0f  /* of the RANK-th brightest around */
#define UNSURE 0.7f /* standard error by value */

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

/* The factors of the pixels of its kind around, summed up. */
static void sum_around(const DenoiseBuffers *b, size_t pixel, float factors[3])
{
    PixelWindow w = buffers_window(b, pixel, SPREAD_REACH);
    memset(factors, 0, 3 * sizeof *factors);
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (i == pixel || b->kind[i] != b->kind[pixel]) continue;
            for (int c = 0; c < 3; c++) factors[c] += b->factor[c][i];
        }
}

static void add_around(DenoiseBuffers *b, size_t pixel, const float light[3])
{
    PixelWindow w = buffers_window(b, pixel, SPREAD_REACH);
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (i == pixel || b->kind[i] != b->kind[pixel]) continue;
            for (int k = 0; k < 2; k++)
                for (int c = 0; c < 3; c++) b->light[k][c][i] += light[c];
        }
}

/* kept: what share of the pixel's light stays with it. */
static bool spread_pixel(const Before *before, DenoiseBuffers *b, size_t pixel, float kept)
{
    float excess[3], factors[3];
    sum_around(b, pixel, factors);
    if (!(factors[0] > 0)) return false;
    for (int c = 0; c < 3; c++) {
        float light = (1 - kept) * before->mean[c][pixel];
        for (int k = 0; k < 2; k++) b->light[k][c][pixel] -= light;
        b->variance[c][pixel] *= kept * kept;
        excess[c] = light * b->factor[c][pixel] / factors[c];
    }
    add_around(b, pixel, excess);
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
