/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/buffers.h"

#include <math.h>
#include <stdio.h>

#include "base/mathf.h"

#define ALBEDO_LEAST 0.02f /* what reflects less is taken as this: noise must not be raised */
#define DEPTH_SCALE 4      /* a step of 25 % in depth counts as one in a normal */
#define DISPLAY_CLOSE 1e-4f

/* The planes of a layer over the data window. */
typedef struct Layers {
    const float *light[3], *variance[3], *halves[3], *normal[3], *albedo[3], *depth[1];
    const float *emitted[3], *reflected[3];
    const float *fine[3], *coverage[1]; /* NULL in frames of earlier programs */
} Layers;

/* ---- reading --------------------------------------------------------------------------- */

static const struct {
    const char *name, *letters;
    size_t      offset;
} WANTED[] = {
    {"", "RGB", offsetof(Layers, light)},
    {"variance", "RGB", offsetof(Layers, variance)},
    {"halves", "RGB", offsetof(Layers, halves)},
    {"normal", "XYZ", offsetof(Layers, normal)},
    {"albedo", "RGB", offsetof(Layers, albedo)},
    {"depth", "Z", offsetof(Layers, depth)},
    {"display.emitted", "RGB", offsetof(Layers, emitted)},
    {"display.reflected", "RGB", offsetof(Layers, reflected)},
};

enum { WANTED_COUNT = sizeof WANTED / sizeof *WANTED };

static bool find_layer(const FrameImage *frame, int wanted, Layers *out)
{
    const float **planes = (const float **)(void *)((char *)out + WANTED[wanted].offset);
    const char   *layer = WANTED[wanted].name;
    for (int c = 0; WANTED[wanted].letters[c]; c++) {
        char name[64];
        snprintf(name, sizeof name, "%s%s%c", layer, *layer ? "." : "",
                 WANTED[wanted].letters[c]);
        planes[c] = frame_channel(frame, name);
        if (!planes[c]) return false;
    }
    return true;
}

static void find_fine(const FrameImage *frame, Layers *out)
{
    static const char *const names[] = {"display.fine.R", "display.fine.G", "display.fine.B"};
    out->coverage[0] = frame_channel(frame, "display.coverage");
    for (int c = 0; c < 3; c++) {
        out->fine[c] = frame_channel(frame, names[c]);
        if (!out->fine[c]) out->coverage[0] = NULL;
    }
}

static bool find_layers(const FrameImage *frame, Arena scratch, Layers *out, Error *err)
{
    const char *missing = "";
    for (int i = 0; i < WANTED_COUNT; i++)
        if (!find_layer(frame, i, out))
            missing = arena_format(&scratch, "%s%s%s", missing, *missing ? ", " : "",
                                   *WANTED[i].name ? WANTED[i].name : "R, G, B");
    find_fine(frame, out);
    if (!*missing) return true;
    return error_set(err, ERROR_INPUT,
                     "has not what --denoise goes by (missing: %s) — render it with --layers "
                     DENOISE_LAYERS, missing);
}

/* How many of the samples first .. end - 1 are of the second half (film/pixels.h: every second
 * block of 16). */
static double odd_samples(long first, long end)
{
    long odd = 0;
    for (long at = first - first % 16; at < end; at += 16) {
        long from = at > first ? at : first, to = at + 16 < end ? at + 16 : end;
        if (at / 16 % 2) odd += to - from;
    }
    return (double)odd;
}

/* False without halves: fewer than 8 samples in one, or a frame that states no samples, or not
 * those of all pixels. */
static bool find_shares(const FrameImage *frame, float share[2])
{
    const char *samples = frame_string(frame, "parhelion:samples");
    long        first, end;
    if (frame_string(frame, "parhelion:for")) return false;
    if (!samples || sscanf(samples, "%ld:%ld", &first, &end) != 2 || first < 0 || end <= first)
        return false;
    share[0] = (float)(odd_samples(first, end) / (double)(end - first));
    share[1] = 1 - share[0];
    return (double)share[0] * (double)(end - first) >= 8 &&
           (double)share[1] * (double)(end - first) >= 8;
}

/* ---- one pixel ------------------------------------------------------------------------- */

static bool are_finite(const float *const planes[3], size_t i)
{
    return isfinite(planes[0][i]) && isfinite(planes[1][i]) && isfinite(planes[2][i]);
}

static bool is_whole_display(const Layers *layers, size_t i)
{
    for (int c = 0; c < 3; c++) {
        float light = layers->light[c][i];
        float parts = layers->emitted[c][i] + layers->reflected[c][i];
        float size = fabsf(layers->emitted[c][i]) + fabsf(layers->reflected[c][i]);
        if (!(fabsf(light - parts) <= DISPLAY_CLOSE * size)) return false;
    }
    return true;
}

/* Whether layers give the light that displays send more exactly than the pixel's own
 * samples. */
static bool has_fine(const Layers *layers, size_t i)
{
    return layers->coverage[0] && isfinite(layers->coverage[0][i]) &&
           are_finite(layers->fine, i) && are_finite(layers->emitted, i);
}

static PixelKind kind_of(const Layers *layers, size_t i)
{
    if (!are_finite(layers->light, i) || !are_finite(layers->variance, i)) return PIXEL_LEFT;
    if (isfinite(layers->emitted[0][i]))
        return has_fine(layers, i) || is_whole_display(layers, i) ? PIXEL_DISPLAY : PIXEL_LEFT;
    bool is_surface = are_finite(layers->normal, i) && are_finite(layers->albedo, i) &&
                      layers->depth[0][i] > 0 && isfinite(layers->depth[0][i]);
    return is_surface ? PIXEL_SURFACE : PIXEL_VOID;
}

static void split_pixel(const Layers *layers, size_t i, DenoiseBuffers *out)
{
    bool  shines = out->kind[i] == PIXEL_DISPLAY;
    bool  reflects = out->kind[i] == PIXEL_SURFACE || shines;
    float odd = sqrtf(out->share[1] / out->share[0]), even = odd > 0 ? 1 / odd : 0;
    for (int c = 0; c < 3; c++) {
        float albedo = reflects ? layers->albedo[c][i] : 1;
        float factor = isfinite(albedo) ? fmaxf(albedo, ALBEDO_LEAST) : 1;
        float seen = shines ? layers->emitted[c][i] : 0, base = seen;
        if (shines && has_fine(layers, i)) {
            seen *= layers->coverage[0][i];
            base = layers->fine[c][i];
        }
        if (out->kind[i] == PIXEL_LEFT) base = layers->light[c][i];
        float light = out->kind[i] ? (layers->light[c][i] - seen) / factor : 0;
        float half = out->has_halves ? layers->halves[c][i] / factor : 0;
        if (!isfinite(half) || !out->kind[i]) half = 0;
        out->factor[c][i] = factor;
        out->base[c][i] = base;
        out->variance[c][i] = out->kind[i] ? layers->variance[c][i] / (factor * factor) : 0;
        out->light[0][c][i] = light + half * odd;
        out->light[1][c][i] = light - half * even;
    }
}

static void fill_features(const Layers *layers, size_t i, const DenoiseBuffers *buffers)
{
    BufferRow row = {1};
    bool      has_surface = buffers->kind[i] == PIXEL_SURFACE;
    bool      has_features = has_surface || buffers->kind[i] == PIXEL_DISPLAY;
    for (int c = 0; c < 3 && has_features; c++) {
        if (isfinite(layers->normal[c][i])) row[ROW_NORMAL + c] = layers->normal[c][i];
        if (isfinite(layers->albedo[c][i])) row[ROW_ALBEDO + c] = layers->albedo[c][i];
    }
    if (has_features && layers->depth[0][i] > 0 && isfinite(layers->depth[0][i]))
        row[ROW_DEPTH] = DEPTH_SCALE * log_f(layers->depth[0][i]);
    buffers->rows[i] = row;
}

/* ---- all of them ----------------------------------------------------------------------- */

static DenoiseBuffers allocate(const FrameImage *frame, Arena *arena)
{
    DenoiseBuffers b = {.width = frame->data.x1 - frame->data.x0,
                        .height = frame->data.y1 - frame->data.y0};
    size_t count = frame_pixel_count(frame);
    b.rows = arena_alloc(arena, sizeof *b.rows, sizeof *b.rows, count);
    b.kind = ARENA_NEW(arena, unsigned char, count);
    for (int c = 0; c < 3; c++) {
        b.light[0][c] = ARENA_NEW(arena, float, count);
        b.light[1][c] = ARENA_NEW(arena, float, count);
        b.variance[c] = ARENA_NEW(arena, float, count);
        b.factor[c] = ARENA_NEW(arena, float, count);
        b.base[c] = ARENA_NEW(arena, float, count);
    }
    return b;
}

bool buffers_create(const FrameImage *frame, Arena *arena, DenoiseBuffers *out, Error *err)
{
    Layers layers;
    if (!find_layers(frame, *arena, &layers, err)) return false;
    DenoiseBuffers buffers = allocate(frame, arena);
    buffers.has_halves = find_shares(frame, buffers.share);
    if (!buffers.has_halves) buffers.share[0] = 1, buffers.share[1] = 0;
    for (size_t i = 0; i < frame_pixel_count(frame); i++) {
        buffers.kind[i] = (unsigned char)kind_of(&layers, i);
        split_pixel(&layers, i, &buffers);
        fill_features(&layers, i, &buffers);
    }
    *out = buffers;
    return true;
}

void buffers_fill_rows(DenoiseBuffers *b)
{
    for (size_t i = 0; i < (size_t)b->width * (size_t)b->height; i++)
        for (int k = 0; k < 2; k++)
            for (int c = 0; c < 3; c++) b->rows[i][ROW_LIGHT + 3 * k + c] = b->light[k][c][i];
}
