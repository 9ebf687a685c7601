/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/correction.h"

#include <math.h>

#include "base/mathf.h"
#include "base/parallel.h"

#define STRICTNESS 1.5f /* squared standard errors that are not believed */

typedef struct Correction {
    const DenoiseBuffers *buffers;
    float *const         *light;
    float                *add[3];
    int                   reach;
} Correction;

typedef struct Residual {
    float sum[3], variance[3], weight;
} Residual;

static Residual residual_around(const Correction *work, size_t pixel, int x0, int y0)
{
    const DenoiseBuffers *b = work->buffers;
    PixelWindow w = buffers_window(b, pixel, work->reach);
    Residual    r = {{0}, {0}, 0};
    float       narrow = -2 / (float)(work->reach * work->reach);
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (b->kind[i] != b->kind[pixel]) continue;
            float distance = (float)((x - x0) * (x - x0) + (y - y0) * (y - y0));
            float weight = exp_f(narrow * distance -
                                 BUFFERS_UNLIKE * buffers_feature_distance(b, pixel, i));
            for (int c = 0; c < 3; c++) {
                r.sum[c] += weight * (buffers_mean(b, c, i) - work->light[c][i]);
                r.variance[c] += weight * weight * b->variance[c][i];
            }
            r.weight += weight;
        }
    return r;
}

/* The positive part of James and Stein's shrinkage: nothing of a difference within its standard
 * error, all of one far beyond. */
static void correct_row(void *context, int y, int worker)
{
    const Correction     *work = context;
    const DenoiseBuffers *b = work->buffers;
    (void)worker;
    for (int x = 0; x < b->width; x++) {
        size_t i = (size_t)y * (size_t)b->width + (size_t)x;
        if (b->kind[i] == PIXEL_LEFT) continue;
        Residual r = residual_around(work, i, x, y);
        float    sigma[3];
        for (int c = 0; c < 3; c++) sigma[c] = sqrtf(r.variance[c]);
        float error = buffers_luminance(sigma), found = buffers_luminance(r.sum);
        float unsure = STRICTNESS * error * error, square = found * found;
        if (!(square > unsure)) continue;
        for (int c = 0; c < 3; c++)
            work->add[c][i] = (1 - unsure / square) * r.sum[c] / r.weight;
    }
}

void correction_add(const DenoiseBuffers *b, float *const light[3], int reach, int threads,
                    Arena scratch)
{
    size_t     count = (size_t)b->width * (size_t)b->height;
    Correction work = {.buffers = b, .light = light, .reach = reach};
    for (int c = 0; c < 3; c++) work.add[c] = ARENA_NEW(&scratch, float, count);
    parallel_for(threads, b->height, correct_row, &work);
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < count; i++) light[c][i] += work.add[c][i];
}
