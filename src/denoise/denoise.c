/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/denoise.h"

#include <math.h>

#include "base/mathf.h"
#include "base/parallel.h"
#include "denoise/buffers.h"
#include "denoise/feature_weights.h"
#include "denoise/fireflies.h"
#include "denoise/noise.h"
#include "denoise/patch_weights.h"
#include "denoise/pilot.h"
#include "denoise/regression.h"

enum { COARSE = 6, FINE = 2 }; /* reaches of the corrections */

/* ---- of two filters, each pixel's better one --------------------------------------------- */

/* What a filter made of one half of the samples is held against the other half, whose noise it
 * does not have: it differs from it by that noise, the same for both filters, and by the
 * filter's own error (Rousselle, Knaus and Zwicker 2012). Over the pixels around, the smaller
 * difference marks the better filter. */

/* Both filters' results for each half: R, G, B. */
typedef struct Candidates {
    float *patches[2][3], *features[2][3];
} Candidates;

enum { REACH = 4 };

typedef struct FilterChoice {
    const DenoiseBuffers *buffers;
    const Candidates     *candidates;
    float                *gain; /* a pixel: how much closer the filter by features came */
    float                *share; /* of the filter by features, 0 to 1 */
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
            float patches = work->candidates->patches[half][c][i];
            float features = work->candidates->features[half][c][i];
            float unit = b->variance[c][i] + 1e-6f * square(buffers_mean(b, c, i)) + 1e-20f;
            gain += (square(patches - other) - square(features - other)) / unit;
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

/* Puts into the light by patches, of both halves, the better of the two, and a mean of both
 * where it is unsure. The buffers have halves. */
static void selection_apply(const DenoiseBuffers *b, const Candidates *candidates, int threads,
                            Arena scratch)
{
    size_t       count = (size_t)b->width * (size_t)b->height;
    FilterChoice work = {b, candidates, ARENA_NEW(&scratch, float, count),
                         ARENA_NEW(&scratch, float, count)};
    parallel_for(threads, b->height, fill_gains, &work);
    parallel_for(threads, b->height, fill_shares, &work);
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < 3; c++) {
            float       *kept = candidates->patches[half][c];
            const float *other = candidates->features[half][c];
            for (size_t i = 0; i < count; i++) kept[i] += work.share[i] * (other[i] - kept[i]);
        }
}

/* ---- what the filter took away and noise cannot have been -------------------------------- */

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

/* light: the filtered light, R, G, B. The difference between it and the buffers' own, averaged
 * over pixels of like features at most `reach` away, is added as far as it is larger than its
 * standard error lets expect. */
static void correction_add(const DenoiseBuffers *b, float *const light[3], int reach,
                           int threads, Arena scratch)
{
    size_t     count = (size_t)b->width * (size_t)b->height;
    Correction work = {.buffers = b, .light = light, .reach = reach};
    for (int c = 0; c < 3; c++) work.add[c] = ARENA_NEW(&scratch, float, count);
    parallel_for(threads, b->height, correct_row, &work);
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < count; i++) light[c][i] += work.add[c][i];
}

/* ---- the filters ------------------------------------------------------------------------- */

/* How fast unlike patches stop to count, where noisy light guides. A half that guides itself
 * must be generous: every patch is most like itself. */
#define STRENGTH_OF_HALVES 2.0f
#define STRENGTH_ALONE 0.4f

typedef struct Scratch {
    PatchScratch *patches;
    float       (*weights)[PATCH_OFFSETS];
} Scratch;

typedef struct Filtering {
    const DenoiseBuffers *buffers;
    PatchGuide            guide;
    bool                  is_last;      /* the filter by features runs, too */
    int                   tiles_x, tiles_y;
    int                   odd_x, odd_y; /* which tiles' turn it is */
    Scratch              *scratch;      /* one a worker */
    RegressionSums        patches[2], features[2]; /* of each half */
} Filtering;

static void filter_pixel(const Filtering *work, int half, int x, int y, float *weights)
{
    const DenoiseBuffers  *b = work->buffers;
    const RegressionWindow window = {b, x, y, PATCH_SEARCH, weights};
    if (b->kind[(size_t)y * (size_t)b->width + (size_t)x] == PIXEL_LEFT) return;
    regression_add(&window, half, &work->patches[half]);
    if (!work->is_last) return;
    feature_weights(b, x, y, weights);
    regression_add(&window, half, &work->features[half]);
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
        patch_weights(&work->guide, half, x0, y0, scratch->patches, scratch->weights);
        for (int k = 0; k < PATCH_TILE * PATCH_TILE; k++) {
            int x = x0 + k % PATCH_TILE, y = y0 + k / PATCH_TILE;
            if (x < b->width && y < b->height)
                filter_pixel(work, half, x, y, scratch->weights[k]);
        }
    }
}

/* The mean of the fits; where there is none, the light as it was. */
static void average_fits(const DenoiseBuffers *b, int half, const RegressionSums *sums)
{
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < (size_t)b->width * (size_t)b->height; i++)
            sums->light[c][i] = sums->weight[i] > 0 ? sums->light[c][i] / sums->weight[i]
                                                    : b->light[half][c][i];
}

static RegressionSums create_sums(size_t count, Arena *arena)
{
    RegressionSums sums;
    for (int c = 0; c < 3; c++) sums.light[c] = ARENA_NEW(arena, float, count);
    sums.weight = ARENA_NEW(arena, float, count);
    return sums;
}

/* Windows reach into the tiles around: of every two by two tiles one is filtered at a time, so
 * that no two write to one pixel and the order of sums is always the same. */
static void filter_tiles(Filtering *work, int threads, Arena *arena)
{
    size_t count = (size_t)work->buffers->width * (size_t)work->buffers->height;
    for (int half = 0; half < 2; half++) {
        work->patches[half] = create_sums(count, arena);
        if (work->is_last) work->features[half] = create_sums(count, arena);
    }
    for (int turn = 0; turn < 4; turn++) {
        work->odd_x = turn % 2;
        work->odd_y = turn / 2;
        int columns = (work->tiles_x - work->odd_x + 1) / 2;
        int rows = (work->tiles_y - work->odd_y + 1) / 2;
        parallel_for(threads, columns * rows, filter_tile, work);
    }
    for (int half = 0; half < 2; half++) {
        average_fits(work->buffers, half, &work->patches[half]);
        if (work->is_last) average_fits(work->buffers, half, &work->features[half]);
    }
}

static Filtering create_filtering(const DenoiseBuffers *b, int threads, Arena *arena)
{
    Filtering work = {.buffers = b, .guide = {.buffers = b},
                      .tiles_x = (b->width + PATCH_TILE - 1) / PATCH_TILE,
                      .tiles_y = (b->height + PATCH_TILE - 1) / PATCH_TILE,
                      .scratch = ARENA_NEW(arena, Scratch, threads)};
    work.guide.strength = b->has_halves ? STRENGTH_OF_HALVES : STRENGTH_ALONE;
    for (int c = 0; c < 3; c++) {
        for (int half = 0; half < 2; half++) work.guide.light[half][c] = b->light[half][c];
        work.guide.variance[c] = b->variance[c];
    }
    for (int i = 0; i < threads; i++) {
        work.scratch[i].patches = patch_scratch_create(arena);
        work.scratch[i].weights = arena_alloc(arena, sizeof *work.scratch[i].weights,
                                              sizeof(float), (size_t)PATCH_TILE * PATCH_TILE);
    }
    return work;
}

/* Once more, guided by what the first filter made, and by features alone. */
static void filter_again(Filtering *work, int threads, Arena *arena)
{
    Candidates candidates;
    float     *first[2][3];
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < 3; c++) first[half][c] = work->patches[half].light[c];
    work->guide = pilot_guide(work->buffers, first, threads, arena);
    work->is_last = true;
    filter_tiles(work, threads, arena);
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < 3; c++) {
            candidates.patches[half][c] = work->patches[half].light[c];
            candidates.features[half][c] = work->features[half].light[c];
        }
    selection_apply(work->buffers, &candidates, threads, *arena);
}

static void join_halves(const Filtering *work, float *const light[3])
{
    const DenoiseBuffers *b = work->buffers;
    for (size_t i = 0; i < (size_t)b->width * (size_t)b->height; i++)
        for (int c = 0; c < 3; c++)
            light[c][i] = b->share[0] * work->patches[0].light[c][i] +
                          b->share[1] * work->patches[1].light[c][i];
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
    filter_tiles(&work, threads, &scratch);
    if (b->has_halves) filter_again(&work, threads, &scratch);
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
