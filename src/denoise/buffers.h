/* SPDX-License-Identifier: Apache-2.0 */
/* buffers.h -- what the filter works on: a frame's layers, taken apart so that what is filtered
 * is smooth.
 *
 * A pixel of the frame is  light * factor + base:
 *   factor   the albedo of what was hit, so that textures need no filter; 1 where nothing was;
 *   base     what a display sends to the eye itself, never filtered: display.fine;
 *   light    the rest, which is filtered: the pixel without what its own samples saw of it,
 *            emitted times coverage. Their edges, which few samples place badly, go with it.
 * Frames without the last two layers have display.emitted for base, the noise of its edges
 * included. Where a display covers a pixel in part, emitted + reflected is then not the pixel;
 * such pixels belong, as those that are not finite always do, to no kind: they stay as they are
 * (base is all of them), and they filter nothing.
 *
 * Units    light in cd m^-2 over albedo, linear Rec.709.
 * Layout   the data window, row by row.
 * Memory   from the arena.
 * Threads  built by one thread, then only read.
 */
#pragma once
#include "base/mathf.h"
#include "image/frame.h"

/* The layers that the filter needs, as --layers names them. */
#define DENOISE_LAYERS \
    "variance,halves,normal,albedo,depth,display.emitted,display.reflected,display.fine"

/* A pixel's row in the regression (regression.h). */
enum {
    ROW_ONE = 0,
    ROW_NORMAL = 1,  /* 3 */
    ROW_ALBEDO = 4,  /* 3 */
    ROW_DEPTH = 7,   /* its logarithm */
    ROW_X = 8, ROW_Y = 9,
    ROW_FEATURES = 10,
    ROW_LIGHT = 10,  /* 3 of each half: R, G, B */
    ROW_SIZE = 16
};

typedef float BufferRow __attribute__((vector_size(4 * ROW_SIZE), aligned(64)));

typedef enum PixelKind {
    PIXEL_LEFT,    /* as it is: not finite, or a display's edge without display.fine */
    PIXEL_SURFACE,
    PIXEL_VOID,    /* no surface: the sky itself */
    PIXEL_DISPLAY
} PixelKind;

typedef struct DenoiseBuffers {
    int            width, height;
    bool           has_halves;
    float          share[2];    /* of the samples that each half has, 1 in all; without
                                   halves 1 and 0 */
    BufferRow     *rows;        /* features, and light once buffers_fill_rows was called */
    float         *light[2][3]; /* of each half; the same without has_halves */
    float         *variance[3]; /* of the mean of both halves' light */
    float         *factor[3], *base[3];
    unsigned char *kind;
} DenoiseBuffers;

/* Fails, with the layers that are missing and how to have them, when the frame lacks one. */
bool buffers_create(const FrameImage *frame, Arena *arena, DenoiseBuffers *out, Error *err);

/* Puts the halves' light into the rows. */
void buffers_fill_rows(DenoiseBuffers *buffers);

/* Both halves together, weighed by their samples. */
static inline float buffers_mean(const DenoiseBuffers *buffers, int channel, size_t pixel)
{
    return buffers->share[0] * buffers->light[0][channel][pixel] +
           buffers->share[1] * buffers->light[1][channel][pixel];
}

/* How much two pixels' normals, albedos and depths differ, squared; 1 is a normal turned by 60
 * degrees, an albedo of 1 beside 0, or 25 % of depth. */
static inline float buffers_feature_distance(const DenoiseBuffers *buffers, size_t a, size_t b)
{
    const BufferRow between = buffers->rows[a] - buffers->rows[b];
    float           square = 0;
    for (int j = ROW_NORMAL; j <= ROW_DEPTH; j++) square += between[j] * between[j];
    return square;
}

#define BUFFERS_UNLIKE 20.0f /* how fast pixels of other features stop to count */

/* 1 where the features are the same, to 0. */
static inline float buffers_likeness(const DenoiseBuffers *buffers, size_t a, size_t b)
{
    return exp_f(-BUFFERS_UNLIKE * buffers_feature_distance(buffers, a, b));
}

/* The pixels at most `reach` from one, half-open. */
typedef struct PixelWindow {
    int x0, y0, x1, y1;
} PixelWindow;

static inline PixelWindow buffers_window(const DenoiseBuffers *b, size_t pixel, int reach)
{
    int x = (int)(pixel % (size_t)b->width), y = (int)(pixel / (size_t)b->width);
    return (PixelWindow){x > reach ? x - reach : 0, y > reach ? y - reach : 0,
                         x + reach < b->width ? x + reach + 1 : b->width,
                         y + reach < b->height ? y + reach + 1 : b->height};
}

static inline float buffers_luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}
