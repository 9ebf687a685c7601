/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/denoise.h"

#include <math.h>

#include "base/parallel.h"
#include "denoise/correction.h"
#include "denoise/fireflies.h"
#include "denoise/noise.h"
#include "denoise/patch_weights.h"
#include "denoise/regression.h"
#include "denoise/selection.h"

enum { COARSE = 6, FINE = 2 }; /* reaches of the corrections */

typedef struct Scratch {
    PatchScratch *patches;
    float       (*weights)[PATCH_OFFSETS];
} Scratch;

typedef struct Filtering {
    const DenoiseBuffers *buffers;
    int                   tiles_x, tiles_y;
    int                   odd_x, odd_y; /* which tiles' turn it is */
    Scratch              *scratch;      /* one a worker */
    RegressionSums        wide[2], narrow[2]; /* of each half */
} Filtering;

/* The weights of the narrow filter: only what is very much alike counts. */
static void sharpen(float weights[PATCH_OFFSETS])
{
    for (int k = 0; k < PATCH_OFFSETS; k++) {
        float fourth = weights[k] * weights[k] * weights[k] * weights[k];
        weights[k] = fourth * fourth < 1e-3f ? 0 : fourth * fourth;
    }
}

static void filter_pixel(const Filtering *work, int half, int x, int y, float *weights)
{
    const DenoiseBuffers  *b = work->buffers;
    const RegressionWindow window = {b, x, y, PATCH_SEARCH, weights};
    if (b->kind[(size_t)y * (size_t)b->width + (size_t)x] == PIXEL_LEFT) return;
    regression_add(&window, half, &work->wide[half]);
    if (!b->has_halves) return;
    sharpen(weights);
    regression_add(&window, half, &work->narrow[half]);
}

static void filter_tile(void *context, int item, int worker)
{
    const Filtering      *work = context;
    const DenoiseBuffers *b = work->buffers;
    const Scratch        *scratch = &work->scratch[worker];
    int columns = (work->tiles_x - work->odd_x + 1) / 2;
    int x0 = (item % columns * 2 + work->odd_x) * PATCH_TILE;
    int y0 = (item / columns * 2 + work->odd_y) * PATCH_TILE;
    for (int half = 0; half < (b->has_halves ? 2 : 1); half++) {
        patch_weights(b, half, x0, y0, scratch->patches, scratch->weights);
        for (int k = 0; k < PATCH_TILE * PATCH_TILE; k++) {
            int x = x0 + k % PATCH_TILE, y = y0 + k / PATCH_TILE;
            if (x < b->width && y < b->height)
                filter_pixel(work, half, x, y, scratch->weights[k]);
        }
    }
}

/* Windows reach into the tiles around: of every two by two tiles one is filtered at a time, so
 * that no two write to one pixel and the order of sums is always the same. */
static void filter_tiles(Filtering *work, int threads)
{
    for (int turn = 0; turn < 4; turn++) {
        work->odd_x = turn % 2;
        work->odd_y = turn / 2;
        int columns = (work->tiles_x - work->odd_x + 1) / 2;
        int rows = (work->tiles_y - work->odd_y + 1) / 2;
        parallel_for(threads, columns * rows, filter_tile, work);
    }
}

static RegressionSums create_sums(size_t count, Arena *arena)
{
    RegressionSums sums;
    for (int c = 0; c < 3; c++) sums.light[c] = ARENA_NEW(arena, float, count);
    sums.weight = ARENA_NEW(arena, float, count);
    return sums;
}

static Filtering create_filtering(const DenoiseBuffers *b, int threads, Arena *arena)
{
    size_t    count = (size_t)b->width * (size_t)b->height;
    Filtering work = {.buffers = b, .tiles_x = (b->width + PATCH_TILE - 1) / PATCH_TILE,
                      .tiles_y = (b->height + PATCH_TILE - 1) / PATCH_TILE,
                      .scratch = ARENA_NEW(arena, Scratch, threads)};
    for (int i = 0; i < threads; i++) {
        work.scratch[i].patches = patch_scratch_create(arena);
        work.scratch[i].weights = arena_alloc(arena, sizeof *work.scratch[i].weights,
                                              sizeof(float), (size_t)PATCH_TILE * PATCH_TILE);
    }
    for (int half = 0; half < 2; half++) {
        work.wide[half] = create_sums(count, arena);
        work.narrow[half] = create_sums(count, arena);
    }
    return work;
}

/* The mean of the fits; where there is none, the light as it was. */
static void average_fits(const DenoiseBuffers *b, int half, const RegressionSums *sums)
{
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < (size_t)b->width * (size_t)b->height; i++)
            sums->light[c][i] = sums->weight[i] > 0 ? sums->light[c][i] / sums->weight[i]
                                                    : b->light[half][c][i];
}

static void select_filters(const Filtering *work, int threads, Arena scratch)
{
    Candidates candidates;
    for (int half = 0; half < 2; half++) {
        average_fits(work->buffers, half, &work->wide[half]);
        average_fits(work->buffers, half, &work->narrow[half]);
        for (int c = 0; c < 3; c++) {
            candidates.wide[half][c] = work->wide[half].light[c];
            candidates.narrow[half][c] = work->narrow[half].light[c];
        }
    }
    if (work->buffers->has_halves)
        selection_apply(work->buffers, &candidates, threads, scratch);
}

static void join_halves(const Filtering *work, float *const light[3])
{
    const DenoiseBuffers *b = work->buffers;
    for (size_t i = 0; i < (size_t)b->width * (size_t)b->height; i++)
        for (int c = 0; c < 3; c++)
            light[c][i] = b->share[0] * work->wide[0].light[c][i] +
                          b->share[1] * work->wide[1].light[c][i];
}

/* Single fits may be negative: without those that are, what is left of the noise would be
 * brighter than what was there. Their mean is cut at 0, or at the frame's own value where that
 * is negative. */
static void keep_positive(const DenoiseBuffers *b, float *const light[3])
{
    for (size_t i = 0; i < (size_t)b->width * (size_t)b->height; i++)
        for (int c = 0; c < 3; c++)
            light[c][i] = fmaxf(light[c][i], fminf(0, buffers_mean(b, c, i)));
}

static void filter(const DenoiseBuffers *b, float *const light[3], int threads, Arena scratch)
{
    Filtering work = create_filtering(b, threads, &scratch);
    filter_tiles(&work, threads);
    select_filters(&work, threads, scratch);
    join_halves(&work, light);
    correction_add(b, light, COARSE, threads, scratch);
    correction_add(b, light, FINE, threads, scratch);
    keep_positive(b, light);
}

/* Light becomes the frame again; returns the luminance of all of it. */
static void compose(const DenoiseBuffers *b, float *const light[3])
{
    for (size_t i = 0; i < (size_t)b->width * (size_t)b->height; i++)
        for (int c = 0; c < 3; c++)
            light[c][i] = b->kind[i] == PIXEL_LEFT
                              ? b->base[c][i]
                              : light[c][i] * b->factor[c][i] + b->base[c][i];
}

static double energy_of(const FrameImage *frame)
{
    const float *rgb[3];
    double       sum = 0;
    frame_rgb(frame, "", rgb);
    for (size_t i = 0; i < frame_pixel_count(frame); i++) {
        float luminance = buffers_luminance((float[]){rgb[0][i], rgb[1][i], rgb[2][i]});
        if (isfinite(luminance)) sum += (double)luminance;
    }
    return sum;
}

bool denoise_frame(const FrameImage *frame, int threads, Arena *arena, FrameImage *out,
                   DenoiseReport *report, Error *err)
{
    DenoiseBuffers buffers;
    DenoiseReport  made = {0};
    float         *light[3];
    Arena          kept = *arena;
    FrameImage     filtered = frame_create(1, 1, frame->data, 3, 0, &kept);
    filtered.display = frame->display;
    for (int c = 0; c < 3; c++)
        light[c] = frame_add_channel(&filtered, (char[]){"RGB"[c], 0}, false, &kept);
    Arena scratch = kept;
    if (!buffers_create(frame, &scratch, &buffers, err)) return false;
    made.has_halves = buffers.has_halves;
    made.fireflies = fireflies_spread(&buffers, scratch);
    noise_estimate(&buffers, scratch);
    buffers_fill_rows(&buffers);
    filter(&buffers, light, threads, scratch);
    compose(&buffers, light);
    double before = energy_of(frame);
    made.energy_ratio = before > 0 ? energy_of(&filtered) / before : 1;
    *arena = kept;
    *out = filtered;
    *report = made;
    return true;
}
