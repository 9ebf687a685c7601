/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/symbol.h"

#include <math.h>

#include "image/content_contrast.h"
#include "image/texture.h"
#include "review/symbol/symbol_shape.h"

#define PARTLY 0.05 /* of the classes' distance: nearer to each other, pixels are alike */

static size_t pixel_count(const ContentLight *light)
{
    return (size_t)light->width * (size_t)light->height;
}

static bool refuse(const SymbolQuestion *question, Error *err, const char *why)
{
    const double *uv = question->uv;
    return error_set(err, ERROR_INPUT, "uv [%g, %g, %g, %g]: %s", uv[0], uv[1], uv[2], uv[3],
                     why);
}

/* ---- classes by luminance ---------------------------------------------------------------- */

/* Means and numbers of what is below and above the threshold. */
typedef struct TwoHalves {
    double mean[2];
    long   count[2];
} TwoHalves;

static TwoHalves halves_of(const ContentLight *light, double threshold)
{
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
                           Error *err)
{
    ContentPixels pixels = {split->light.width, split->light.height, split->light.cd_m2, NULL};
    ContentContrast contrast = content_contrast(&pixels, scratch);
    if (contrast.verdict == CONTENT_TOO_SMALL && pixel_count(&split->light) < 16)
        return refuse(question, err, "the rectangle holds fewer than 16 pixels of its content");
    if (contrast.verdict == CONTENT_TOO_SMALL)
        return refuse(question, err, "everything in the rectangle has one luminance");
    if (!(contrast.separability > 0))
        return refuse(question, err, "nearly everything in the rectangle has one luminance: a "
                                     "foreground fills at least half a percent of it");
    split->threshold_cd_m2 = contrast.threshold;
    split->separability = contrast.separability;
    return true;
}

/* Is a pixel of the half a mixture: beside the other half, and less clearly of its own than a
 * neighbour is? */
static bool is_mixed(const ContentLight *light, double threshold, double clearly, int x, int y)
{
    size_t w = (size_t)light->width;
    double own = (double)light->cd_m2[(size_t)y * w + (size_t)x];
    bool   is_above = own > threshold, touches = false, is_surpassed = false;
    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < light->height; j++) {
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < light->width; i++) {
            double other = (double)light->cd_m2[(size_t)j * w + (size_t)i];
            if ((other > threshold) != is_above) touches = true;
            else if (is_above ? other > own + clearly : other < own - clearly)
                is_surpassed = true;
        }
    }
    return touches && is_surpassed;
}

static void set_classes(const TwoHalves *halves, int foreground, SymbolSplit *split)
{
    const ContentLight *light = &split->light;
    double clearly = PARTLY * (halves->mean[1] - halves->mean[0]);
    for (int y = 0; y < light->height; y++) {
        for (int x = 0; x < light->width; x++) {
            size_t at = (size_t)y * (size_t)light->width + (size_t)x;
            int    half = (double)light->cd_m2[at] > split->threshold_cd_m2;
            split->class_of[at] =
                is_mixed(light, split->threshold_cd_m2, clearly, x, y) ? SYMBOL_EDGE
                : half == foreground                                   ? SYMBOL_FOREGROUND
                                                                       : SYMBOL_BACKGROUND;
        }
    }
}

static bool split_by_luminance(const SymbolQuestion *question, SymbolSplit *split,
                               Arena scratch, Error *err)
{
    if (!find_threshold(question, split, scratch, err)) return false;
    TwoHalves halves = halves_of(&split->light, split->threshold_cd_m2);
    int foreground = question->polarity == POLARITY_AUTO
                         ? halves.count[1] <= halves.count[0]
                         : question->polarity == POLARITY_LIGHT_ON_DARK;
    set_classes(&halves, foreground, split);
    return true;
}

/* ---- classes by a mask ------------------------------------------------------------------- */

static SymbolClass masked_class(const Image *mask, int x, int y)
{
    float   rgba[4];
    Texture texture = {*mask, WRAP_CLAMP, WRAP_CLAMP, true};
    texture_data(&texture, ((float)x + 0.5f) / (float)mask->width,
                 ((float)y + 0.5f) / (float)mask->height, rgba);
    float grey = (rgba[0] + rgba[1] + rgba[2]) / 3;
    if (rgba[3] < 0.5f || (grey >= 0.25f && grey <= 0.75f)) return SYMBOL_EDGE;
    return grey > 0.75f ? SYMBOL_FOREGROUND : SYMBOL_BACKGROUND;
}

static bool split_by_mask(const SymbolQuestion *question, SymbolSplit *split, Error *err)
{
    const ContentLight *light = &split->light;
    const Image        *mask = question->mask;
    if (mask->width != light->content_width || mask->height != light->content_height)
        return error_set(err, ERROR_INPUT,
                         "the mask has %d x %d pixels, its content %d x %d", mask->width,
                         mask->height, light->content_width, light->content_height);
    split->separability = split->threshold_cd_m2 = (double)NAN;
    for (int y = 0; y < light->height; y++)
        for (int x = 0; x < light->width; x++)
            split->class_of[(size_t)y * (size_t)light->width + (size_t)x] =
                (uint8_t)masked_class(mask, light->x + x, light->y + y);
    return true;
}

/* ---- what they are ----------------------------------------------------------------------- */

static void count_classes(SymbolSplit *split)
{
    double sum[3] = {0};
    long   count[3] = {0};
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

static bool check_classes(const SymbolQuestion *question, const SymbolSplit *split, Error *err)
{
    if (!split->foreground_count)
        return refuse(question, err, "the mask is nowhere white there: no foreground");
    if (!split->background_count)
        return refuse(question, err, "the mask is nowhere black there: no background");
    if (question->polarity == POLARITY_AUTO ||
        split->is_light_on_dark == (question->polarity == POLARITY_LIGHT_ON_DARK))
        return true;
    return refuse(question, err, split->is_light_on_dark
                                     ? "the mask's foreground is light on dark, and polarity "
                                       "says \"dark-on-light\""
                                     : "the mask's foreground is not light on dark, and "
                                       "polarity says \"light-on-dark\"");
}

/* How much of the foreground's light a pixel has: an edge is never whole. */
static SymbolDrawing drawing_of(const SymbolSplit *split, Arena *arena)
{
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

static void set_shape(SymbolSplit *split, Arena scratch)
{
    const ContentLight *light = &split->light;
    SymbolDrawing drawing = drawing_of(split, &scratch);
    SymbolShape   shape = symbol_shape(&drawing, scratch);
    split->box[0] = (light->x + shape.left) / light->content_width;
    split->box[1] = (light->y + shape.top) / light->content_height;
    split->box[2] = (light->x + shape.right) / light->content_width;
    split->box[3] = (light->y + shape.bottom) / light->content_height;
    split->stroke_px = shape.stroke_px;
    split->character_v = shape.character_px / light->content_height;
}

bool symbol_split(const SymbolQuestion *question, Arena *arena, SymbolSplit *out, Error *err)
{
    SymbolSplit split = {0};
    if (!question->content)
        return error_set(err, ERROR_INPUT, "the display has no content: it shows white alone");
    if (!content_light(question->panel, question->content, question->uv, arena, &split.light,
                       err))
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
