/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/pilot.h"

#include "base/parallel.h"

#define STRENGTH 2.0f
#define LEAST_SHARE 0.1f  /* of the unfiltered variance: halves may agree by chance */

enum { REACH = 3 };

typedef struct PilotNoise {
    const DenoiseBuffers *buffers;
    float               *(*light)[3];
    float                *variance[3];
} PilotNoise;

/* What noise the filter left: the halves' difference, over like pixels around. */
static float variance_at(const PilotNoise *work, int c, size_t pixel)
{
    const DenoiseBuffers *b = work->buffers;
    PixelWindow           w = buffers_window(b, pixel, REACH);
    float                 sum = 0, count = 0;
    for (int y = w.y0; y < w.y1; y++)
        for (int x = w.x0; x < w.x1; x++) {
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            if (b->kind[i] != b->kind[pixel]) continue;
            float between = work->light[0][c][i] - work->light[1][c][i];
            float like = buffers_likeness(b, pixel, i);
            sum += like * between * between;
            count += like;
        }
    float least = LEAST_SHARE * b->variance[c][pixel];
    float found = b->share[0] * b->share[1] * sum / count;
    return found > least ? found : least;
}

static void fill_row(void *context, int y, int worker)
{
    const PilotNoise     *work = context;
    const DenoiseBuffers *b = work->buffers;
    (void)worker;
    for (int x = 0; x < b->width; x++) {
        size_t i = (size_t)y * (size_t)b->width + (size_t)x;
        for (int c = 0; c < 3 && b->kind[i] != PIXEL_LEFT; c++)
            work->variance[c][i] = variance_at(work, c, i);
    }
}

PatchGuide pilot_guide(const DenoiseBuffers *b, float *light[2][3], int threads,
                       Arena *arena)
{
    PilotNoise work = {.buffers = b, .light = light};
    PatchGuide guide = {.buffers = b, .strength = STRENGTH};
    for (int c = 0; c < 3; c++) {
        work.variance[c] = ARENA_NEW(arena, float, (size_t)b->width * (size_t)b->height);
        guide.variance[c] = work.variance[c];
        for (int half = 0; half < 2; half++) guide.light[half][c] = light[half][c];
    }
    parallel_for(threads, b->height, fill_row, &work);
    return guide;
}
