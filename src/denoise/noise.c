/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/noise.h"

#include <math.h>
#include <string.h>

#include "base/mathf.h"

#define REACH 4           /* pixels around that show how much the samples' spread overstates */
#define DISPLAY_REACH 2
#define WIDE_SHARE 0.3f   /* of the mean around: no pixel is surer because no light found it */
#define RATIO_LEAST 0.05f /* of the halves' variance to that of the samples' spread */
#define RATIO_MOST 1.5f

/* The difference of the halves, scaled so that its square has the variance for its mean. */
static float halves_at(const DenoiseBuffers *b, int c, size_t i)
{
    return (b->light[0][c][i] - b->light[1][c][i]) * sqrtf(b->share[0] * b->share[1]);
}

/* ---- displays ---------------------------------------------------------------------------- */

/* A display's content has edges inside pixels, which widen the spread but are no noise of its
 * reflection: the median of the variances around is that of the reflection alone. */
static float median_around(const DenoiseBuffers *b, const float *variance, size_t pixel)
{
    PixelWindow w = buffers_window(b, pixel, DISPLAY_REACH);
    float       found[(2 * DISPLAY_REACH + 1) * (2 * DISPLAY_REACH + 1)];
    int         count = 0;
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (b->kind[i] != PIXEL_DISPLAY) continue;
            int at = count++;
            for (; at > 0 && found[at - 1] > variance[i]; at--) found[at] = found[at - 1];
            found[at] = variance[i];
        }
    return found[count / 2];
}

/* The square of what a display's pixel differs by from the mean of its neighbours on both
 * sides, in x or in y: 3/2 of the variance where the reflection is straight. Adds up. */
static void add_bend(const DenoiseBuffers *b, int c, size_t pixel, size_t step, double sum[2])
{
    if (b->kind[pixel - step] != PIXEL_DISPLAY || b->kind[pixel + step] != PIXEL_DISPLAY)
        return;
    float bend = buffers_mean(b, c, pixel) -
                 0.5f * (buffers_mean(b, c, pixel - step) + buffers_mean(b, c, pixel + step));
    sum[0] += 2.0 / 3 * (double)bend * (double)bend;
    sum[1]++;
}

/* The variance of the reflection from its neighbours; that of the samples is spread by content
 * too, wherever there is fine content all over the window of the median. */
static float bent_around(const DenoiseBuffers *b, int c, size_t pixel)
{
    PixelWindow w = buffers_window(b, pixel, REACH);
    double      sum[2] = {0, 0};
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (b->kind[i] != PIXEL_DISPLAY) continue;
            if (x > 0 && x < b->width - 1) add_bend(b, c, i, 1, sum);
            if (y > 0 && y < b->height - 1) add_bend(b, c, i, (size_t)b->width, sum);
        }
    return sum[1] > 0 ? (float)(sum[0] / sum[1]) : INFINITY;
}

/* Keeps the halves within two standard errors of their mean. */
static void bound_halves(DenoiseBuffers *b, int c, size_t i)
{
    float mean = buffers_mean(b, c, i), found = fabsf(halves_at(b, c, i));
    float most = 2 * sqrtf(b->variance[c][i]);
    if (!(found > most)) return;
    for (int k = 0; k < 2; k++)
        b->light[k][c][i] = mean + (b->light[k][c][i] - mean) * (most / found);
}

static void separate_displays(DenoiseBuffers *b, float *copy)
{
    size_t count = (size_t)b->width * (size_t)b->height;
    for (int c = 0; c < 3; c++) {
        memcpy(copy, b->variance[c], count * sizeof *copy);
        for (size_t i = 0; i < count; i++) {
            if (b->kind[i] != PIXEL_DISPLAY) continue;
            b->variance[c][i] = fminf(median_around(b, copy, i), bent_around(b, c, i));
            bound_halves(b, c, i);
        }
    }
}

/* ---- all pixels -------------------------------------------------------------------------- */

typedef struct SpreadSums {
    float halves, wide, count, near, near_count;
} SpreadSums;

static SpreadSums sums_around(const DenoiseBuffers *b, const float *spread, int c, size_t pixel)
{
    PixelWindow w = buffers_window(b, pixel, REACH), near = buffers_window(b, pixel, 1);
    SpreadSums  sums = {0};
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (b->kind[i] != b->kind[pixel]) continue;
            float half = halves_at(b, c, i);
            float like = buffers_likeness(b, pixel, i);
            sums.halves += like * half * half;
            sums.wide += like * spread[i];
            sums.count += like;
            if (x < near.x0 || x >= near.x1 || y < near.y0 || y >= near.y1) continue;
            sums.near += like * spread[i];
            sums.near_count += like;
        }
    return sums;
}

/* A mean over few samples has an uncertain spread: the mean of it over neighbours of one kind
 * is surer. And scrambled Sobol points are better than the independent ones that the spread
 * takes them for; what they gain shows in the halves, over many pixels. */
static float estimate(const DenoiseBuffers *b, const float *spread, int c, size_t pixel)
{
    SpreadSums sums = sums_around(b, spread, c, pixel);
    float      mean = fmaxf(sums.near / sums.near_count, WIDE_SHARE * sums.wide / sums.count);
    if (!b->has_halves || !(sums.wide > 0)) return mean;
    return mean * clampf(sums.halves / sums.wide, RATIO_LEAST, RATIO_MOST);
}

void noise_estimate(DenoiseBuffers *b, Arena scratch)
{
    size_t count = (size_t)b->width * (size_t)b->height;
    float *spread = ARENA_NEW(&scratch, float, count);
    separate_displays(b, spread);
    for (int c = 0; c < 3; c++) {
        memcpy(spread, b->variance[c], count * sizeof *spread);
        for (size_t i = 0; i < count; i++) b->variance[c][i] = estimate(b, spread, c, i);
    }
}
