/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/text_parts.h"

#include <math.h>
#include <stdlib.h>

#include "review/symbol/connected.h"

/* Limits of a character's shape, in its own height. */
#define LEAST_HEIGHT_PX 7
#define IN_LAYER 3        /* so often goes it into the layer's height */
#define WIDEST 2.5
#define BROADEST_STROKE 0.28
#define LEAST_FILLED 0.12 /* of its box */
#define LEAST_STEP 0.16  /* of lightness: what is dimmer on black has 2.5 % of the peak */

/* PartSums over a part's pixels. */
typedef struct PartSums {
    double lightness;
    double range;                  /* over those of its edge */
    long   edge_pixels, edge_sides; /* sides: of pixels, that look out of the part */
} PartSums;

static uint8_t *pixels_of(const TextLayer *layer, Arena *arena)
{
    size_t   all = (size_t)layer->width * (size_t)layer->height;
    uint8_t *set = ARENA_NEW(arena, uint8_t, all);
    for (size_t i = 0; i < all; i++)
        set[i] = (layer->lightness[i] > layer->threshold) == layer->is_light;
    return set;
}

/* at: a pixel that is not on the border. */
static double range_about(const TextLayer *layer, size_t at)
{
    float low = INFINITY, high = -INFINITY;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            float value = layer->lightness[at + (size_t)(j * layer->width + i)];
            low = fminf(low, value);
            high = fmaxf(high, value);
        }
    return (double)(high - low);
}

static PartSums *sums_of(const TextLayer *layer, const ConnectedParts *parts, Arena *arena)
{
    PartSums  *sums = ARENA_NEW(arena, PartSums, parts->count);
    size_t w = (size_t)layer->width;
    for (size_t y = 1; y + 1 < (size_t)layer->height; y++) {
        for (size_t x = 1; x + 1 < w; x++) {
            size_t         at = y * w + x;
            const int32_t *own = &parts->part_of[at];
            if (*own < 0) continue;
            int sides = (own[-1] != *own) + (own[1] != *own) + (*(own - w) != *own) +
                        (own[w] != *own);
            sums[*own].lightness += (double)layer->lightness[at];
            if (!sides) continue;
            sums[*own].edge_sides += sides;
            sums[*own].edge_pixels++;
            sums[*own].range += range_about(layer, at);
        }
    }
    return sums;
}

static bool may_be_character(const TextPart *part, long pixels, const TextLayer *layer)
{
    double w = part->right - part->left + 1, h = part->bottom - part->top + 1;
    return h >= LEAST_HEIGHT_PX && h * IN_LAYER <= layer->height && w <= WIDEST * h &&
           part->stroke_px <= BROADEST_STROKE * h && (double)pixels >= LEAST_FILLED * w * h;
}

static int from_left(const void *a, const void *b)
{
    const TextPart *p = a, *q = b;
    return p->left != q->left ? (p->left > q->left) - (p->left < q->left)
                              : (p->top > q->top) - (p->top < q->top);
}

int text_parts(const TextLayer *layer, Arena *arena, TextPart **out)
{
    ConnectedParts parts = connected_parts(pixels_of(layer, arena), layer->width,
                                           layer->height, arena);
    PartSums     *sums = sums_of(layer, &parts, arena);
    TextPart *list = ARENA_NEW(arena, TextPart, parts.count);
    int       count = 0;
    for (int i = 0; i < parts.count; i++) {
        const ConnectedPart *p = &parts.part[i];
        if (p->left == 0 || p->top == 0 || p->right == layer->width - 1 ||
            p->bottom == layer->height - 1)
            continue;
        TextPart part = {p->left, p->top, p->right, p->bottom,
                         2 * (double)p->pixels / (double)sums[i].edge_sides,
                         sums[i].range / (double)sums[i].edge_pixels,
                         sums[i].lightness / (double)p->pixels, false};
        part.is_character = may_be_character(&part, p->pixels, layer);
        if (part.step >= LEAST_STEP) list[count++] = part;
    }
    qsort(list, (size_t)count, sizeof *list, from_left);
    *out = list;
    return count;
}
