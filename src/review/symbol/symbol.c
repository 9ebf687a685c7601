/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/symbol.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/sort.h"
#include "base/vec.h"
#include "image/content_contrast.h"
#include "image/texture.h"
#include "review/symbol/content_light.h"

/* ---- size of what is drawn --------------------------------------------------------------- */

/* The share of each pixel that is drawn on: 1 is whole, less is an edge. Units of all of this:
 * pixels of the drawing, its first row's upper edge at 0. */
typedef struct SymbolDrawing {
    int width, height;
    const float *share; /* width * height, row by row; at least one is whole */
} SymbolDrawing;

typedef struct SymbolShape {
    double left, top, right, bottom; /* of what is whole, and its edges by their share */
    double stroke_px;    /* median over whole pixels of their shortest chord (level, upright,
                            both diagonals) */
    double character_px; /* median height of the connected parts (over gaps of less than a third
                            of stroke_px) that stand beside the tallest, without those less
                            than half as tall */
} SymbolShape;

/* Wider edges than this are no edges: a glow. */
#define EDGE_PIXELS 2

static float share_at(const SymbolDrawing *d, int x, int y) {
    if (x < 0 || y < 0 || x >= d->width || y >= d->height) return 0;
    return d->share[(size_t)y * (size_t)d->width + (size_t)x];
}

/* Sorts the values; count: at least 1. */
static double median(float *values, long count) {
    sort_floats(values, count);
    return 0.5 * ((double)values[(count - 1) / 2] + (double)values[count / 2]);
}

/* ---- extent ------------------------------------------------------------------------------ */

/* The greatest share of a line of pixels: column x from `first` to `last`, or row x. */
static double most_of_line(const SymbolDrawing *d, bool is_column, int at, int first, int last) {
    float most = 0;
    for (int i = first; i <= last; i++)
        most = fmaxf(most, is_column ? share_at(d, at, i) : share_at(d, i, at));
    return (double)most;
}

/* How far the edge reaches beyond the line `at` of whole pixels, going by `step`. */
static double edge_beyond(const SymbolDrawing *d, bool is_column, int at, int step,
                          const int across[2]) {
    double sum = 0, before = 1;
    for (int k = 1; k <= EDGE_PIXELS; k++) {
        double share = most_of_line(d, is_column, at + k * step, across[0], across[1]);
        if (share >= before) break; /* another part begins */
        sum += share;
        before = share;
    }
    return sum;
}

/* Lines of the part's whole pixels alone: edges come by their share. */
static bool whole_box(const SymbolDrawing *d, const ConnectedPart *part, ConnectedPart *whole) {
    *whole = (ConnectedPart){d->width, d->height, -1, -1, 0};
    for (int y = part->top; y <= part->bottom; y++) {
        for (int x = part->left; x <= part->right; x++) {
            if (share_at(d, x, y) < 1) continue;
            if (x < whole->left) whole->left = x;
            if (x > whole->right) whole->right = x;
            if (y < whole->top) whole->top = y;
            whole->bottom = y;
            whole->pixels++;
        }
    }
    return whole->pixels > 0;
}

static double top_of(const SymbolDrawing *d, const ConnectedPart *whole) {
    int across[2] = {whole->left, whole->right};
    return whole->top - edge_beyond(d, false, whole->top, -1, across);
}

static double bottom_of(const SymbolDrawing *d, const ConnectedPart *whole) {
    int across[2] = {whole->left, whole->right};
    return whole->bottom + 1 + edge_beyond(d, false, whole->bottom, 1, across);
}

static void set_extent(const SymbolDrawing *d, SymbolShape *out) {
    ConnectedPart all = {0, 0, d->width - 1, d->height - 1, 0}, whole;
    if (!whole_box(d, &all, &whole)) return;
    int across[2] = {whole.top, whole.bottom};
    out->left = whole.left - edge_beyond(d, true, whole.left, -1, across);
    out->right = whole.right + 1 + edge_beyond(d, true, whole.right, 1, across);
    out->top = top_of(d, &whole);
    out->bottom = bottom_of(d, &whole);
}

/* ---- strokes ----------------------------------------------------------------------------- */

/* The ways of a chord: two steps in turn, so that a slanted one leaves out no pixel. */
typedef struct ChordWay {
    int step[2][2];
    float length; /* of a step along the chord */
} ChordWay;

#define HALF_DIAGONAL 0.70710678f

static const ChordWay WAYS[4] = {{{{1, 0}, {1, 0}}, 1},
                                 {{{0, 1}, {0, 1}}, 1},
                                 {{{1, 0}, {0, 1}}, HALF_DIAGONAL},
                                 {{{-1, 0}, {0, 1}}, HALF_DIAGONAL}};

/* Pixels along a chord from its end up to and with each, by which step it was reached. */
typedef struct Chords {
    float *by[2];
} Chords;

static Chords new_chords(const SymbolDrawing *d, Arena *arena) {
    size_t all = (size_t)d->width * (size_t)d->height;
    return (Chords){{ARENA_NEW(arena, float, all), ARENA_NEW(arena, float, all)}};
}

/* A whole pixel is one more than the chord before it; an edge begins with what is left. */
static float chord_up_to(const SymbolDrawing *d, const float *before, int x, int y,
                         const int from[2]) {
    int bx = x - from[0], by = y - from[1];
    float own = share_at(d, x, y), outer = share_at(d, bx, by);
    if (own < 1) return own + (outer < own ? outer : 0);
    return outer > 0 ? 1 + before[(size_t)by * (size_t)d->width + (size_t)bx] : 1;
}

/* sign: 1 from the beginning of the way, -1 from its end. What comes before a pixel must be
 * known before it. */
static void add_chords(const SymbolDrawing *d, const ChordWay *way, int sign, Chords *chords) {
    for (int j = 0; j < d->height; j++) {
        for (int i = 0; i < d->width; i++) {
            int x = sign * way->step[0][0] < 0 ? d->width - 1 - i : i;
            int y = sign < 0 ? d->height - 1 - j : j;
            for (int k = 0; k < 2; k++) {
                int from[2] = {sign * way->step[k][0], sign * way->step[k][1]};
                chords->by[k][(size_t)y * (size_t)d->width + (size_t)x] =
                    chord_up_to(d, chords->by[1 - k], x, y, from);
            }
        }
    }
}

/* A chord that reaches a pixel by one step goes on by the other; both ends count the pixel. */
static double stroke_width(const SymbolDrawing *d, Arena scratch) {
    size_t all = (size_t)d->width * (size_t)d->height;
    long count = 0;
    float *shortest = ARENA_NEW(&scratch, float, all);
    Chords begun = new_chords(d, &scratch), left = new_chords(d, &scratch);
    for (size_t i = 0; i < all; i++) shortest[i] = INFINITY;
    for (int k = 0; k < 4; k++) {
        add_chords(d, &WAYS[k], 1, &begun);
        add_chords(d, &WAYS[k], -1, &left);
        for (size_t i = 0; i < all; i++)
            shortest[i] = fminf(shortest[i], WAYS[k].length * (begun.by[0][i] + left.by[1][i] - 1));
    }
    for (size_t i = 0; i < all; i++)
        if (d->share[i] >= 1) shortest[count++] = shortest[i];
    return median(shortest, count);
}

/* ---- characters -------------------------------------------------------------------------- */

/* Pixels that are half drawn hold a character together, and so do gaps of less than a third of
 * its strokes (segments): each pixel also fills so many to the right and below. */
static ConnectedParts characters(const SymbolDrawing *d, int gap, Arena *arena) {
    int w = d->width + gap, h = d->height + gap;
    uint8_t *set = ARENA_NEW(arena, uint8_t, (size_t)w *(size_t)h);
    for (int y = 0; y < d->height; y++)
        for (int x = 0; x < d->width; x++)
            for (int j = 0; j <= gap && share_at(d, x, y) >= 0.5f; j++)
                memset(set + (size_t)(y + j) * (size_t)w + x, 1, (size_t)gap + 1);
    ConnectedParts parts = connected_parts(set, w, h, arena);
    for (int i = 0; i < parts.count; i++) {
        parts.part[i].right -= gap;
        parts.part[i].bottom -= gap;
    }
    return parts;
}

static bool stands_beside(const ConnectedPart *part, const ConnectedPart *tallest) {
    int top = part->top > tallest->top ? part->top : tallest->top;
    int bottom = part->bottom < tallest->bottom ? part->bottom : tallest->bottom;
    return 2 * (bottom - top + 1) >= part->bottom - part->top + 1;
}

static double character_height(const SymbolDrawing *d, int gap, Arena scratch) {
    ConnectedParts parts = characters(d, gap, &scratch);
    ConnectedPart *whole = ARENA_NEW(&scratch, ConnectedPart, parts.count);
    float *heights = ARENA_NEW(&scratch, float, parts.count);
    double most = 0;
    int tallest = 0;
    long count = 0;
    for (int i = 0; i < parts.count; i++) {
        if (!whole_box(d, &parts.part[i], &whole[i])) continue;
        heights[i] = (float)(bottom_of(d, &whole[i]) - top_of(d, &whole[i]));
        if ((double)heights[i] > most) tallest = i;
        most = fmax(most, (double)heights[i]);
    }
    for (int i = 0; i < parts.count; i++)
        if (2 * (double)heights[i] >= most && stands_beside(&whole[i], &whole[tallest]))
            heights[count++] = heights[i];
    return median(heights, count);
}

static SymbolShape symbol_shape(const SymbolDrawing *drawing, Arena scratch) {
    SymbolShape shape = {0};
    set_extent(drawing, &shape);
    shape.stroke_px = stroke_width(drawing, scratch);
    shape.character_px = character_height(drawing, (int)(shape.stroke_px / 3), scratch);
    return shape;
}

#define PARTLY 0.05 /* of the classes' distance: nearer to each other, pixels are alike */

static size_t pixel_count(const ContentLight *light) {
    return (size_t)light->width * (size_t)light->height;
}

static bool refuse(const SymbolQuestion *question, Error *err, const char *why) {
    const double *uv = question->uv;
    return error_set(err, ERROR_INPUT, "uv [%g, %g, %g, %g]: %s", uv[0], uv[1], uv[2], uv[3], why);
}

/* ---- classes by luminance ---------------------------------------------------------------- */

/* Means and numbers of what is below and above the threshold. */
typedef struct TwoHalves {
    double mean[2];
    long count[2];
} TwoHalves;

static TwoHalves halves_of(const ContentLight *light, double threshold) {
    TwoHalves halves = {{0}, {0}};
    for (size_t i = 0; i < pixel_count(light); i++) {
        int half = (double)light->cd_m2[i] > threshold;
        halves.mean[half] += (double)light->cd_m2[i];
        halves.count[half]++;
    }
    for (int k = 0; k < 2; k++) halves.mean[k] /= (double)halves.count[k];
    return halves;
}

static bool find_threshold(const SymbolQuestion *question, SymbolSplit *split, Arena scratch,
                           Error *err) {
    ContentPixels pixels = {split->light.width, split->light.height, split->light.cd_m2, NULL};
    ContentContrast contrast = content_contrast(&pixels, scratch);
    if (contrast.verdict == CONTENT_TOO_SMALL && pixel_count(&split->light) < 16)
        return refuse(question, err, "the rectangle holds fewer than 16 pixels of its content");
    if (contrast.verdict == CONTENT_TOO_SMALL)
        return refuse(question, err, "everything in the rectangle has one luminance");
    if (!(contrast.separability > 0))
        return refuse(question, err,
                      "nearly everything in the rectangle has one luminance: a "
                      "foreground fills at least half a percent of it");
    split->threshold_cd_m2 = contrast.threshold;
    split->separability = contrast.separability;
    return true;
}

/* Is a pixel of the half a mixture: beside the other half, and less clearly of its own than a
 * neighbour is? */
static bool is_mixed(const ContentLight *light, double threshold, double clearly, int x, int y) {
    size_t w = (size_t)light->width;
    double own = (double)light->cd_m2[(size_t)y * w + (size_t)x];
    bool is_above = own > threshold, touches = false, is_surpassed = false;
    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < light->height; j++) {
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < light->width; i++) {
            double other = (double)light->cd_m2[(size_t)j * w + (size_t)i];
            if ((other > threshold) != is_above) touches = true;
            else if (is_above ? other > own + clearly : other < own - clearly) is_surpassed = true;
        }
    }
    return touches && is_surpassed;
}

static void set_classes(const TwoHalves *halves, int foreground, SymbolSplit *split) {
    const ContentLight *light = &split->light;
    double clearly = PARTLY * (halves->mean[1] - halves->mean[0]);
    for (int y = 0; y < light->height; y++) {
        for (int x = 0; x < light->width; x++) {
            size_t at = (size_t)y * (size_t)light->width + (size_t)x;
            int half = (double)light->cd_m2[at] > split->threshold_cd_m2;
            split->class_of[at] = is_mixed(light, split->threshold_cd_m2, clearly, x, y)
                                      ? SYMBOL_EDGE
                                  : half == foreground ? SYMBOL_FOREGROUND
                                                       : SYMBOL_BACKGROUND;
        }
    }
}

static bool split_by_luminance(const SymbolQuestion *question, SymbolSplit *split, Arena scratch,
                               Error *err) {
    if (!find_threshold(question, split, scratch, err)) return false;
    TwoHalves halves = halves_of(&split->light, split->threshold_cd_m2);
    int foreground = question->polarity == POLARITY_AUTO
                         ? halves.count[1] <= halves.count[0]
                         : question->polarity == POLARITY_LIGHT_ON_DARK;
    set_classes(&halves, foreground, split);
    return true;
}

/* ---- classes by a mask ------------------------------------------------------------------- */

static SymbolClass masked_class(const Image *mask, int x, int y) {
    float rgba[4];
    Texture texture = {*mask, WRAP_CLAMP, WRAP_CLAMP, true};
    texture_data(&texture, ((float)x + 0.5f) / (float)mask->width,
                 ((float)y + 0.5f) / (float)mask->height, rgba);
    float grey = (rgba[0] + rgba[1] + rgba[2]) / 3;
    if (rgba[3] < 0.5f || (grey >= 0.25f && grey <= 0.75f)) return SYMBOL_EDGE;
    return grey > 0.75f ? SYMBOL_FOREGROUND : SYMBOL_BACKGROUND;
}

static bool split_by_mask(const SymbolQuestion *question, SymbolSplit *split, Error *err) {
    const ContentLight *light = &split->light;
    const Image *mask = question->mask;
    if (mask->width != light->content_width || mask->height != light->content_height)
        return error_set(err, ERROR_INPUT, "the mask has %d x %d pixels, its content %d x %d",
                         mask->width, mask->height, light->content_width, light->content_height);
    split->separability = split->threshold_cd_m2 = (double)NAN;
    for (int y = 0; y < light->height; y++)
        for (int x = 0; x < light->width; x++)
            split->class_of[(size_t)y * (size_t)light->width + (size_t)x] =
                (uint8_t)masked_class(mask, light->x + x, light->y + y);
    return true;
}

/* ---- what they are ----------------------------------------------------------------------- */

static void count_classes(SymbolSplit *split) {
    double sum[3] = {0};
    long count[3] = {0};
    for (size_t i = 0; i < pixel_count(&split->light); i++) {
        sum[split->class_of[i]] += (double)split->light.cd_m2[i];
        count[split->class_of[i]]++;
    }
    split->foreground_count = count[SYMBOL_FOREGROUND];
    split->background_count = count[SYMBOL_BACKGROUND];
    split->edge_count = count[SYMBOL_EDGE];
    split->foreground_cd_m2 = sum[SYMBOL_FOREGROUND] / (double)count[SYMBOL_FOREGROUND];
    split->background_cd_m2 = sum[SYMBOL_BACKGROUND] / (double)count[SYMBOL_BACKGROUND];
    split->is_light_on_dark = split->foreground_cd_m2 > split->background_cd_m2;
}

static bool check_classes(const SymbolQuestion *question, const SymbolSplit *split, Error *err) {
    if (!split->foreground_count)
        return refuse(question, err, "the mask is nowhere white there: no foreground");
    if (!split->background_count)
        return refuse(question, err, "the mask is nowhere black there: no background");
    if (question->polarity == POLARITY_AUTO ||
        split->is_light_on_dark == (question->polarity == POLARITY_LIGHT_ON_DARK))
        return true;
    return refuse(question, err,
                  split->is_light_on_dark ? "the mask's foreground is light on dark, and polarity "
                                            "says \"dark-on-light\""
                                          : "the mask's foreground is not light on dark, and "
                                            "polarity says \"light-on-dark\"");
}

/* How much of the foreground's light a pixel has: an edge is never whole. */
static SymbolDrawing drawing_of(const SymbolSplit *split, Arena *arena) {
    float *share = ARENA_NEW(arena, float, pixel_count(&split->light));
    double low = split->background_cd_m2, step = split->foreground_cd_m2 - low;
    for (size_t i = 0; i < pixel_count(&split->light); i++) {
        double of_edge = ((double)split->light.cd_m2[i] - low) / step;
        of_edge = of_edge > 0 ? fmin(of_edge, 0.999) : 0; /* step 0: none */
        share[i] = split->class_of[i] == SYMBOL_FOREGROUND ? 1
                   : split->class_of[i] == SYMBOL_EDGE     ? (float)of_edge
                                                           : 0;
    }
    return (SymbolDrawing){split->light.width, split->light.height, share};
}

static void set_shape(SymbolSplit *split, Arena scratch) {
    const ContentLight *light = &split->light;
    SymbolDrawing drawing = drawing_of(split, &scratch);
    SymbolShape shape = symbol_shape(&drawing, scratch);
    split->box[0] = (light->x + shape.left) / light->content_width;
    split->box[1] = (light->y + shape.top) / light->content_height;
    split->box[2] = (light->x + shape.right) / light->content_width;
    split->box[3] = (light->y + shape.bottom) / light->content_height;
    split->stroke_px = shape.stroke_px;
    split->character_v = shape.character_px / light->content_height;
}

bool symbol_split(const SymbolQuestion *question, Arena *arena, SymbolSplit *out, Error *err) {
    SymbolSplit split = {0};
    if (!question->content)
        return error_set(err, ERROR_INPUT, "the display has no content: it shows white alone");
    if (!content_light(question->panel, question->content, question->uv, arena, &split.light, err))
        return false;
    split.class_of = ARENA_NEW(arena, uint8_t, pixel_count(&split.light));
    bool done = question->mask ? split_by_mask(question, &split, err)
                               : split_by_luminance(question, &split, *arena, err);
    if (!done) return false;
    count_classes(&split);
    if (!check_classes(question, &split, err)) return false;
    set_shape(&split, *arena);
    *out = split;
    return true;
}
