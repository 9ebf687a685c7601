/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/selection.h"

#include <math.h>

#include "base/mathf.h"
#include "base/parallel.h"

enum { REACH = 4 };

typedef struct FilterChoice {
    const DenoiseBuffers *buffers;
    const Candidates     *candidates;
    float                *gain; /* a pixel: how much closer the narrow filter came */
    float                *share; /* of the narrow filter, 0 to 1 */
} FilterChoice;

static float square(float value)
{
    return value * value;
}

/* In units of the light's variance, so that bright pixels do not decide for dark ones. */
static float gain_of(const FilterChoice *work, size_t i)
{
    const DenoiseBuffers *b = work->buffers;
    float                 gain = 0;
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < 3; c++) {
            float other = b->light[1 - half][c][i];
            float wide = work->candidates->wide[half][c][i];
            float narrow = work->candidates->narrow[half][c][i];
            float unit = b->variance[c][i] + 1e-6f * square(buffers_mean(b, c, i)) + 1e-20f;
            gain += (square(wide - other) - square(narrow - other)) / unit;
        }
    return gain;
}

static void fill_gains(void *context, int y, int worker)
{
    const FilterChoice   *work = context;
    const DenoiseBuffers *b = work->buffers;
    (void)worker;
    for (int x = 0; x < b->width; x++) {
        size_t i = (size_t)y * (size_t)b->width + (size_t)x;
        if (b->kind[i] != PIXEL_LEFT) work->gain[i] = gain_of(work, i);
    }
}

/* The gains around by their own uncertainty: nothing below no gain, all from one standard
 * error on. Not on displays, where what is shown makes the halves differ too. */
static float share_at(const FilterChoice *work, size_t pixel)
{
    const DenoiseBuffers *b = work->buffers;
    PixelWindow           w = buffers_window(b, pixel, REACH);
    float                 sum = 0, squares = 0;
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (b->kind[i] != b->kind[pixel]) continue;
            float like = buffers_likeness(b, pixel, i);
            sum += like * work->gain[i];
            squares += square(like * work->gain[i]);
        }
    return sum > 0 ? fminf(sum / sqrtf(squares), 1) : 0;
}

static void fill_shares(void *context, int y, int worker)
{
    const FilterChoice   *work = context;
    const DenoiseBuffers *b = work->buffers;
    (void)worker;
    for (int x = 0; x < b->width; x++) {
        size_t i = (size_t)y * (size_t)b->width + (size_t)x;
        if (b->kind[i] == PIXEL_SURFACE || b->kind[i] == PIXEL_VOID)
            work->share[i] = share_at(work, i);
    }
}

void selection_apply(const DenoiseBuffers *b, const Candidates *candidates, int threads,
                     Arena scratch)
{
    size_t       count = (size_t)b->width * (size_t)b->height;
    FilterChoice work = {b, candidates, ARENA_NEW(&scratch, float, count),
                         ARENA_NEW(&scratch, float, count)};
    parallel_for(threads, b->height, fill_gains, &work);
    parallel_for(threads, b->height, fill_shares, &work);
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < 3; c++)
            for (size_t i = 0; i < count; i++)
                candidates->wide[half][c][i] +=
                    work.share[i] *
                    (candidates->narrow[half][c][i] - candidates->wide[half][c][i]);
}
