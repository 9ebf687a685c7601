/* SPDX-License-Identifier: Apache-2.0 */
#include "measure/light_shares.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/frame_view.h"
#include "spectrum/photometry.h"

#define LIGHT "light."
#define GREEN ".G"

/* The pixels that count, as indices into the data window. */
typedef struct ChosenPixels {
    const size_t *index;
    size_t count;
} ChosenPixels;

static double channel_luminance(const float *const rgb[3], size_t i) {
    float values[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    return (double)luminance_from_rgb(values);
}

static bool is_inside(ExrWindow w, int x, int y) {
    return x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1;
}

/* Layers of lights are of whole pixels: those of a display's rim have the light of what is
 * around, and do not count. */
typedef struct LightPixels {
    const float *ids, *coverage, *second; /* NULL: every pixel counts; all coverages are 1; no
                                             pixel is shared */
    float id;
} LightPixels;

static LightPixels pixels_of(const FrameImage *frame, const char *display) {
    if (!display) return (LightPixels){0};
    return (LightPixels){
        frame_channel(frame, "id.display"), frame_channel(frame, "display.coverage"),
        frame_channel(frame, "id.second"), (float)frame_id_of(frame, "display", display)};
}

static bool counts(const LightPixels *of, size_t i) {
    return !of->ids || (of->ids[i] == of->id && (!of->coverage || of->coverage[i] == 1) &&
                        (!of->second || of->second[i] == -1));
}

static ChosenPixels choose_pixels(const FrameImage *frame, const MeasureRequest *request,
                                  const float *const rgb[3], Arena *arena) {
    ExrWindow d = frame->data, r = request->has_region ? request->region : d;
    LightPixels of = pixels_of(frame, request->display);
    size_t *index = ARENA_NEW(arena, size_t, frame_pixel_count(frame));
    FrameView circle = frame_view_circle(frame);
    ExrWindow w = frame->display;
    ChosenPixels out = {index, 0};
    size_t i = 0;
    for (int y = d.y0; y < d.y1; y++)
        for (int x = d.x0; x < d.x1; x++, i++)
            if (is_inside(r, x, y) && is_inside(w, x, y) && counts(&of, i) &&
                frame_view_sees(&circle, x - w.x0, y - w.y0) && isfinite(channel_luminance(rgb, i)))
                index[out.count++] = i;
    return out;
}

static double mean_luminance(const float *const rgb[3], const ChosenPixels *pixels) {
    double sum = 0;
    for (size_t i = 0; i < pixels->count; i++) sum += channel_luminance(rgb, pixels->index[i]);
    return pixels->count ? sum / (double)pixels->count : 0;
}

/* The layer of a channel light.NAME.G; NULL: it is none. */
static const char *layer_of(const char *channel, Arena *arena) {
    size_t length = strlen(channel), tail = strlen(GREEN);
    if (strncmp(channel, LIGHT, strlen(LIGHT)) != 0 || length <= strlen(LIGHT) + tail ||
        strcmp(channel + length - tail, GREEN) != 0)
        return NULL;
    return arena_string(arena, channel, length - tail);
}

/* NaN sorts last. */
static double rank_of(const LightShare *light) {
    return isnan(light->cd_m2) ? -(double)INFINITY : light->cd_m2;
}

static int compare_shares(const void *a, const void *b) {
    const LightShare *x = a, *y = b;
    double first = rank_of(x), second = rank_of(y);
    if (first != second) return first < second ? 1 : -1;
    return strcmp(x->layer, y->layer);
}

LightShares light_shares_measure(const FrameImage *frame, const MeasureRequest *request,
                                 double luminance, Arena *arena) {
    LightShares out = {ARENA_NEW(arena, LightShare, frame->channel_count), 0, 0};
    const float *rgb[3], *light[3];
    if (!frame_rgb(frame, "", rgb)) return out;
    ChosenPixels pixels = choose_pixels(frame, request, rgb, arena);
    out.pixels = (long)pixels.count;
    double all = mean_luminance(rgb, &pixels);
    for (int i = 0; i < frame->channel_count; i++) {
        const char *layer = layer_of(frame->channels[i].name, arena);
        if (!layer || !frame_rgb(frame, layer, light)) continue;
        const char *name = frame_string(frame, arena_format(arena, "parhelion:%s", layer));
        double cd_m2 = mean_luminance(light, &pixels);
        if (!name) name = layer + strlen(LIGHT);
        double share = all > 0 ? cd_m2 / all : 0;
        out.list[out.count++] =
            (LightShare){layer, name, all > 0 ? share * luminance : cd_m2, share};
    }
    qsort(out.list, (size_t)out.count, sizeof *out.list, compare_shares);
    return out;
}
