/* SPDX-License-Identifier: Apache-2.0 */
#include "base/count.h"
#include "image/layer_view.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/mathf.h"
#include "base/sort.h"
#include "image/colour.h"
#include "image/false_colour.h"
#include "image/srgb.h"

#define MAX_PIXELS ((long long)1 << 28)

/* ---- planes over the display window -------------------------------------------------- */

static bool covers_display(const FrameImage *frame) {
    return !memcmp(&frame->display, &frame->data, sizeof frame->data);
}

/* NaN where the data window does not reach. */
static const float *display_plane(const FrameImage *frame, const float *plane, Arena *arena) {
    const ExrWindow w = frame->display, d = frame->data;
    if (covers_display(frame)) return plane;
    size_t width = (size_t)(w.x1 - w.x0), count = width * (size_t)(w.y1 - w.y0);
    float *out = ARENA_NEW(arena, float, count);
    for (size_t i = 0; i < count; i++) {
        int x = w.x0 + (int)(i % width), y = w.y0 + (int)(i / width);
        bool inside = x >= d.x0 && x < d.x1 && y >= d.y0 && y < d.y1;
        size_t row = (size_t)(d.x1 - d.x0);
        out[i] = inside ? plane[(size_t)(y - d.y0) * row + (size_t)(x - d.x0)] : NAN;
    }
    return out;
}

static size_t pixel_count(const LayerView *view) {
    return (size_t)view->width * (size_t)view->height;
}

/* ---- which channels a name means ----------------------------------------------------- */

/* The properties of known layers; `show` of the others follows from their channels. */
typedef struct KnownLayer {
    const char *name, *channels; /* one letter each after the dot */
    LayerShow show;
    const char *unit;
    bool is_log;
} KnownLayer;

static const KnownLayer KNOWN[] = {
    {"normal", "XYZ", SHOW_DIRECTION, "", false},
    {"position", "XYZ", SHOW_POSITION, "m", false},
    {"albedo", "RGB", SHOW_REFLECTANCE, "", false},
    {"uv", "UV", SHOW_UV, "", false},
    {"xyz", "XYZ", SHOW_LIGHT, "cd/m^2", true},
    {"variance", "RGB", SHOW_NUMBER, "(cd/m^2)^2", true},
    {"halves", "RGB", SHOW_NUMBER, "cd/m^2", true},
    {"depth", "Z", SHOW_NUMBER, "m", true},
    {"samples", "N", SHOW_NUMBER, "samples", false},
    {"display.halves", "RGB", SHOW_NUMBER, "cd/m^2", true},
    {"display.variance", "RGB", SHOW_NUMBER, "(cd/m^2)^2", true},
    {"display.second", "RGB", SHOW_LIGHT, "cd/m^2", true},
    {"display.second.variance", "RGB", SHOW_NUMBER, "(cd/m^2)^2", true},
    {"display.theta", "", SHOW_NUMBER, "deg", false},
    {"display.phi", "", SHOW_NUMBER, "deg", false},
    {"display.contrast", "", SHOW_NUMBER, ": 1", true},
    {"display.coverage", "", SHOW_NUMBER, "of the samples", false},
    {"display.second.coverage", "", SHOW_NUMBER, "of the samples", false},
    {"display.extrapolated.emitted", "", SHOW_NUMBER, "of its luminance", false},
    {"display.extrapolated.reflected", "", SHOW_NUMBER, "of its luminance", false},
    {"stokes.S0", "", SHOW_NUMBER, "cd/m^2", true},
    {"stokes.S1", "", SHOW_NUMBER, "cd/m^2", false},
    {"stokes.S2", "", SHOW_NUMBER, "cd/m^2", false},
    {"stokes.S3", "", SHOW_NUMBER, "cd/m^2", false},
    {"stokes.degree", "", SHOW_NUMBER, "polarised", false},
    {"id.part", "", SHOW_ID, "", false},
    {"id.display", "", SHOW_ID, "", false},
    {"id.second", "", SHOW_ID, "", false},
};

static const KnownLayer *known_layer(const char *name) {
    for (int i = 0; i < COUNT_OF(KNOWN); i++)
        if (!strcmp(name, KNOWN[i].name)) return &KNOWN[i];
    return NULL;
}

static const float *layer_channel(const FrameImage *frame, const char *layer, char last) {
    char name[256];
    snprintf(name, sizeof name, "%s%s%c", layer, layer[0] ? "." : "", last);
    return frame_channel(frame, name);
}

static bool find_planes(const FrameImage *frame, const char *layer, const char *letters,
                        const float *planes[3]) {
    for (int c = 0; letters[c]; c++) {
        planes[c] = layer_channel(frame, layer, letters[c]);
        if (!planes[c]) return false;
    }
    return letters[0] != '\0';
}

/* The layers there are, each once: "R" "G" "B" make "the frame itself". */
static const char *layer_names(const FrameImage *frame, Arena *arena) {
    const char *names = "", *last = "";
    for (int i = 0; i < frame->channel_count; i++) {
        const char *name = frame->channels[i].name, *dot = strrchr(name, '.');
        bool is_letter = dot && strlen(dot) == 2;
        const char *layer =
            dot && is_letter ? arena_string(arena, name, (size_t)(dot - name)) : name;
        if (!strcmp(layer, last)) continue;
        names = arena_format(arena, "%s%s%s", names, names[0] ? ", " : "", layer);
        last = layer;
    }
    return names;
}

static bool unknown_layer(const FrameImage *frame, const char *layer, Arena scratch, Error *err) {
    const char *names = layer_names(frame, &scratch);
    if (!layer[0])
        return error_set(err, ERROR_INPUT, "has no channels R, G, B or Y; it has: %s", names);
    return error_set(err, ERROR_USAGE, "has no layer \"%s\"; it has: %s", layer, names);
}

/* A layer of one channel, or one channel of a layer. */
static bool find_number(const FrameImage *frame, const char *name, LayerView *view) {
    char layer[256];
    const KnownLayer *known = known_layer(name);
    const char *dot = strrchr(name, '.');
    view->planes[0] = frame_channel(frame, name);
    view->show = SHOW_NUMBER;
    if (!known && dot) {
        snprintf(layer, sizeof layer, "%.*s", (int)(dot - name), name);
        known = known_layer(layer);
    }
    if (known) {
        view->show = known->show == SHOW_ID ? SHOW_ID : SHOW_NUMBER;
        view->unit = known->unit;
        view->is_log = known->is_log;
    } else if (strchr("RGBY", dot ? dot[1] : name[0])) {
        view->unit = "cd/m^2";
        view->is_log = true;
    }
    return view->planes[0] != NULL;
}

static bool find_layer(const FrameImage *frame, const char *name, LayerView *view) {
    const KnownLayer *known = known_layer(name);
    if (!strcmp(name, "id") && find_number(frame, "id.part", view)) return true;
    if (known && strlen(known->channels) > 1 &&
        find_planes(frame, name, known->channels, view->planes)) {
        view->show = known->show;
        view->unit = known->unit;
        view->is_log = known->is_log;
        return true;
    }
    if (find_planes(frame, name, "RGB", view->planes)) return true;
    if (!name[0]) return find_planes(frame, name, "YYY", view->planes); /* a grey picture */
    if (find_number(frame, name, view)) return true;
    for (const char *letter = "ZNYVA"; *letter; letter++) {
        char channel[256];
        snprintf(channel, sizeof channel, "%s.%c", name, *letter);
        if (find_number(frame, channel, view)) return true;
    }
    return false;
}

/* ---- into Rec.709 -------------------------------------------------------------------- */

static void convert(LayerView *view, const ColourMatrix *matrix, Arena *arena) {
    float *out[3];
    for (int c = 0; c < 3; c++) out[c] = ARENA_NEW(arena, float, pixel_count(view));
    for (size_t i = 0; i < pixel_count(view); i++) {
        float in[3] = {view->planes[0][i], view->planes[1][i], view->planes[2][i]}, rgb[3];
        colour_apply(matrix, in, rgb);
        for (int c = 0; c < 3; c++) out[c][i] = rgb[c];
    }
    for (int c = 0; c < 3; c++) view->planes[c] = out[c];
}

static void convert_xyz(LayerView *view, Arena *arena) {
    ColourMatrix matrix = rec709_from_primaries(XYZ_CHROMATICITIES);
    convert(view, &matrix, arena);
}

/* A frame's own variance is of R, G, B; one number is the variance of the luminance, taken as
 * if the three rose and fell together, as noise does: its greatest possible value. */
static const float *luminance_variance(const LayerView *view, Arena *arena) {
    float *out = ARENA_NEW(arena, float, pixel_count(view));
    for (size_t i = 0; i < pixel_count(view); i++) {
        float sigma = 0.2126f * sqrtf(view->planes[0][i]) + 0.7152f * sqrtf(view->planes[1][i]) +
                      0.0722f * sqrtf(view->planes[2][i]);
        out[i] = sigma * sigma;
    }
    return out;
}

/* The size of the halves' difference, whichever half was the brighter one. */
static const float *luminance_size(const LayerView *view, Arena *arena) {
    float *out = layer_view_luminance(view, arena);
    for (size_t i = 0; i < pixel_count(view); i++) out[i] = fabsf(out[i]);
    return out;
}

bool layer_view_find(const FrameImage *frame, const char *layer, Arena *arena, LayerView *out,
                     Error *err) {
    const ExrWindow w = frame->display;
    long long width = (long long)w.x1 - w.x0, height = (long long)w.y1 - w.y0;
    LayerView view = {.show = SHOW_LIGHT, .unit = ""};
    if (!layer) layer = "";
    view.has_gaps = !strncmp(layer, "display.", 8) || !strncmp(layer, "halves", 6) ||
                    !strncmp(layer, "stokes.", 7);
    if (!find_layer(frame, layer, &view)) return unknown_layer(frame, layer, *arena, err);
    if (width < 1 || height < 1 || width * height > MAX_PIXELS || width > 65536)
        return error_set(err, ERROR_INPUT,
                         "a display window of %lld x %lld pixels, at most "
                         "%lld pixels are supported",
                         width, height, MAX_PIXELS);
    view.width = (int)width;
    view.height = (int)height;
    for (int c = 0; c < 3; c++)
        if (view.planes[c]) view.planes[c] = display_plane(frame, view.planes[c], arena);
    if (view.show == SHOW_LIGHT && !strcmp(layer, "xyz")) convert_xyz(&view, arena);
    if (view.show == SHOW_NUMBER && view.planes[2])
        view.planes[0] = strcmp(layer, "variance") ? luminance_size(&view, arena)
                                                   : luminance_variance(&view, arena);
    *out = view;
    return true;
}

float *layer_view_luminance(const LayerView *view, Arena *arena) {
    float *out = ARENA_NEW(arena, float, pixel_count(view));
    for (size_t i = 0; i < pixel_count(view); i++)
        out[i] = 0.2126f * view->planes[0][i] + 0.7152f * view->planes[1][i] +
                 0.0722f * view->planes[2][i];
    return out;
}

/* ---- pictures ------------------------------------------------------------------------ */

/* Colours far apart for numbers that follow each other: the golden angle around the hues. */
static void id_colour(float id, float rgb[3]) {
    static const float THIRDS[3] = {0, 1 / 3.0f, 2 / 3.0f};
    int whole = id >= 0 && id < 1e9f ? (int)id : -1;
    float hue = (float)((uint32_t)whole * 2654435769u) * 0x1p-32f; /* 2^32 / golden ratio */
    float value = whole % 3 == 0 ? 0.95f : whole % 3 == 1 ? 0.75f : 0.58f;
    for (int c = 0; c < 3; c++) {
        float distance = fabsf(hue - THIRDS[c]);
        if (distance > 0.5f) distance = 1 - distance;
        rgb[c] = whole < 0 ? 0.0f : value * (0.25f + 0.75f * clampf(2 - 6 * distance, 0, 1));
    }
}

/* From the 5th to the 80th percentile of a plane: mountains far away must not make a cabin
 * one colour. */
static ScaleRange extent_of(const float *plane, size_t count, Arena scratch) {
    float *sorted = ARENA_NEW(&scratch, float, count);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(plane[i])) sorted[kept++] = plane[i];
    if (kept == 0) return (ScaleRange){0, 1, false};
    sort_floats(sorted, (long)kept);
    ScaleRange range = {sorted[(kept - 1) / 20], sorted[(kept - 1) * 4 / 5], false};
    return range.high > range.low ? range : (ScaleRange){range.low, range.low + 1, false};
}

static float shown(LayerShow show, float value, ScaleRange extent) {
    if (!isfinite(value)) return 0;
    switch (show) {
    case SHOW_REFLECTANCE: return srgb_from_linear(clampf(value, 0, 1));
    case SHOW_DIRECTION: return 0.5f + 0.5f * value;
    case SHOW_POSITION: return scale_position(extent, value);
    case SHOW_UV: return value - floorf(value);
    default: return value;
    }
}

static Picture plain_picture(const LayerView *view, Arena *arena) {
    Picture picture = picture_create(view->width, view->height, arena);
    for (int c = 0; c < 3; c++) {
        if (!view->planes[c]) continue;
        ScaleRange extent = {0, 1, false};
        if (view->show == SHOW_POSITION)
            extent = extent_of(view->planes[c], pixel_count(view), *arena);
        for (size_t i = 0; i < pixel_count(view); i++)
            picture.rgb[3 * i + (size_t)c] = shown(view->show, view->planes[c][i], extent);
    }
    return picture;
}

Picture layer_view_picture(const LayerView *view, Arena *arena, char *scale) {
    if (scale) scale[0] = '\0';
    if (view->show == SHOW_ID) {
        Picture picture = picture_create(view->width, view->height, arena);
        for (size_t i = 0; i < pixel_count(view); i++)
            id_colour(view->planes[0][i], picture.rgb + 3 * i);
        return picture;
    }
    if (view->show != SHOW_NUMBER) return plain_picture(view, arena);
    ScaleRange range = {view->low, view->high, view->is_log};
    if (!(view->high > view->low))
        range = scale_range_of(view->planes[0], pixel_count(view), view->is_log, *arena);
    if (scale)
        snprintf(scale, 160, "%g to %g %s, %s", (double)range.low, (double)range.high, view->unit,
                 range.is_log ? "logarithmic" : "linear");
    return false_colour_picture(view->planes[0], view->width, view->height, range, view->unit,
                                arena);
}
