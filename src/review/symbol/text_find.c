/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/text_find.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "review/symbol/content_light.h"

/* ---- parts ------------------------------------------------------------------------------- */

/* The pixels above a threshold of lightness, or below it. */
typedef struct TextLayer {
    int width, height;
    const float *lightness; /* width * height, row by row */
    float threshold;
    bool is_light; /* the parts are above it */
} TextLayer;

typedef struct TextPart {
    int left, top, right, bottom; /* first and last */
    double stroke_px;             /* 2 area / perimeter */
    double step;       /* mean range of lightness in the 3 x 3 about the pixels of its edge */
    double lightness;  /* mean over its pixels */
    bool is_character; /* as high, wide, thin and sharp as one; else perhaps a dot */
} TextPart;

/* Limits of a character's shape, in its own height. */
#define LEAST_HEIGHT_PX 7
#define IN_LAYER 3 /* so often goes it into the layer's height */
#define WIDEST 2.5
#define BROADEST_STROKE 0.28
#define LEAST_FILLED 0.12 /* of its box */
#define LEAST_STEP 0.16   /* of lightness: what is dimmer on black has 2.5 % of the peak */

/* PartSums over a part's pixels. */
typedef struct PartSums {
    double lightness;
    double range;                 /* over those of its edge */
    long edge_pixels, edge_sides; /* sides: of pixels, that look out of the part */
} PartSums;

static uint8_t *pixels_of(const TextLayer *layer, Arena *arena) {
    size_t all = (size_t)layer->width * (size_t)layer->height;
    uint8_t *set = ARENA_NEW(arena, uint8_t, all);
    for (size_t i = 0; i < all; i++)
        set[i] = (layer->lightness[i] > layer->threshold) == layer->is_light;
    return set;
}

/* at: a pixel that is not on the border. */
static double range_about(const TextLayer *layer, size_t at) {
    float low = INFINITY, high = -INFINITY;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            float value = layer->lightness[at + (size_t)(j * layer->width + i)];
            low = fminf(low, value);
            high = fmaxf(high, value);
        }
    return (double)(high - low);
}

static PartSums *sums_of(const TextLayer *layer, const ConnectedParts *parts, Arena *arena) {
    PartSums *sums = ARENA_NEW(arena, PartSums, parts->count);
    size_t w = (size_t)layer->width;
    for (size_t y = 1; y + 1 < (size_t)layer->height; y++) {
        for (size_t x = 1; x + 1 < w; x++) {
            size_t at = y * w + x;
            const int32_t *own = &parts->part_of[at];
            if (*own < 0) continue;
            int sides =
                (own[-1] != *own) + (own[1] != *own) + (*(own - w) != *own) + (own[w] != *own);
            sums[*own].lightness += (double)layer->lightness[at];
            if (!sides) continue;
            sums[*own].edge_sides += sides;
            sums[*own].edge_pixels++;
            sums[*own].range += range_about(layer, at);
        }
    }
    return sums;
}

static bool may_be_character(const TextPart *part, long pixels, const TextLayer *layer) {
    double w = part->right - part->left + 1, h = part->bottom - part->top + 1;
    return h >= LEAST_HEIGHT_PX && h * IN_LAYER <= layer->height && w <= WIDEST * h &&
           part->stroke_px <= BROADEST_STROKE * h && (double)pixels >= LEAST_FILLED * w * h;
}

static int from_left(const void *a, const void *b) {
    const TextPart *p = a, *q = b;
    return p->left != q->left ? (p->left > q->left) - (p->left < q->left)
                              : (p->top > q->top) - (p->top < q->top);
}

/* Those that do not touch the border and are sharp, from left to right. Returns how many. */
static int text_parts(const TextLayer *layer, Arena *arena, TextPart **out) {
    ConnectedParts parts =
        connected_parts(pixels_of(layer, arena), layer->width, layer->height, arena);
    PartSums *sums = sums_of(layer, &parts, arena);
    TextPart *list = ARENA_NEW(arena, TextPart, parts.count);
    int count = 0;
    for (int i = 0; i < parts.count; i++) {
        const ConnectedPart *p = &parts.part[i];
        if (p->left == 0 || p->top == 0 || p->right == layer->width - 1 ||
            p->bottom == layer->height - 1)
            continue;
        TextPart part = {p->left,
                         p->top,
                         p->right,
                         p->bottom,
                         2 * (double)p->pixels / (double)sums[i].edge_sides,
                         sums[i].range / (double)sums[i].edge_pixels,
                         sums[i].lightness / (double)p->pixels,
                         false};
        part.is_character = may_be_character(&part, p->pixels, layer);
        if (part.step >= LEAST_STEP) list[count++] = part;
    }
    qsort(list, (size_t)count, sizeof *list, from_left);
    *out = list;
    return count;
}

/* ---- characters beside each other are a line --------------------------------------------- */

typedef struct ProposedLine {
    int left, top, right, bottom; /* of characters and their dots, first and last */
    int height;                   /* of its tallest character */
    int characters;               /* at least 2 */
    double weight; /* sum of the characters' steps squared, times the root of height */
    bool is_light;
} ProposedLine;

/* How unlike two neighbours of a line may be, and how far from each other. */
#define HEIGHTS 1.8
#define STROKES 1.8
#define LIGHTNESS 0.15
#define GAP 0.8     /* of the taller's height */
#define DOT_GAP 0.5 /* of the line's height */

typedef struct Grouping {
    const TextPart *parts;
    int count;
    int *leader; /* of each part, itself or another of its line; -1: in no line */
} Grouping;

static int height_of(const TextPart *p) {
    return p->bottom - p->top + 1;
}

/* In rows; 0 or less: they share none. */
static int shared_height(const TextPart *a, const TextPart *b) {
    int top = a->top > b->top ? a->top : b->top;
    int bottom = a->bottom < b->bottom ? a->bottom : b->bottom;
    return bottom - top + 1;
}

/* b begins no further left than a. */
static bool are_neighbours(const TextPart *a, const TextPart *b) {
    int low = height_of(a) < height_of(b) ? height_of(a) : height_of(b);
    int high = height_of(a) + height_of(b) - low;
    double thin = fmin(a->stroke_px, b->stroke_px), broad = fmax(a->stroke_px, b->stroke_px);
    int least_width =
        a->right - a->left < b->right - b->left ? a->right - a->left : b->right - b->left;
    int gap = b->left - a->right;
    return gap <= GAP * high && 2 * gap >= -least_width && high <= HEIGHTS * low &&
           2 * shared_height(a, b) >= low && broad <= STROKES * thin &&
           fabs(a->lightness - b->lightness) <= LIGHTNESS;
}

static int leader_of(const Grouping *g, int i) {
    while (g->leader[i] != i) i = g->leader[i];
    return i;
}

static void join(const Grouping *g, int widest_gap) {
    for (int i = 0; i < g->count; i++) {
        if (g->leader[i] < 0) continue;
        for (int j = i + 1; j < g->count; j++) {
            if (g->parts[j].left - g->parts[i].right > widest_gap) break;
            if (g->leader[j] < 0 || !are_neighbours(&g->parts[i], &g->parts[j])) continue;
            int a = leader_of(g, i), b = leader_of(g, j);
            g->leader[a > b ? a : b] = a > b ? b : a;
        }
    }
}

static void widen(ProposedLine *line, const TextPart *p) {
    if (p->left < line->left) line->left = p->left;
    if (p->top < line->top) line->top = p->top;
    if (p->right > line->right) line->right = p->right;
    if (p->bottom > line->bottom) line->bottom = p->bottom;
}

static ProposedLine line_of(const Grouping *g, int leader, bool is_light) {
    const TextPart *first = &g->parts[leader];
    ProposedLine line = {first->left, first->top, first->right, first->bottom, 0, 0, 0, is_light};
    for (int i = leader; i < g->count; i++) {
        const TextPart *p = &g->parts[i];
        if (g->leader[i] < 0 || leader_of(g, i) != leader) continue;
        widen(&line, p);
        if (height_of(p) > line.height) line.height = height_of(p);
        line.characters++;
        line.weight += p->step * p->step * sqrt(height_of(p));
    }
    return line;
}

/* Points, accents, colons: small parts within the line's height or just over it. */
static void add_dots(const Grouping *g, ProposedLine *line) {
    ProposedLine bare = *line;
    int gap = (int)(DOT_GAP * line->height), over = line->height / 4;
    for (int i = 0; i < g->count; i++) {
        const TextPart *p = &g->parts[i];
        if (p->left > bare.right + gap) break;
        if (g->leader[i] < 0 && 2 * height_of(p) <= line->height &&
            2 * (p->right - p->left) <= line->height && p->right >= bare.left - gap &&
            p->top >= bare.top - over && p->bottom <= bare.bottom + over)
            widen(line, p);
    }
}

/* parts: from left to right. Returns how many. */
static int text_lines(const TextPart *parts, int count, bool is_light, Arena *arena,
                      ProposedLine **out) {
    Grouping g = {parts, count, ARENA_NEW(arena, int, count)};
    ProposedLine *lines = ARENA_NEW(arena, ProposedLine, count);
    int found = 0, tallest = 0;
    for (int i = 0; i < count; i++) {
        g.leader[i] = parts[i].is_character ? i : -1;
        if (g.leader[i] == i && height_of(&parts[i]) > tallest) tallest = height_of(&parts[i]);
    }
    join(&g, (int)ceil(GAP * tallest));
    for (int i = 0; i < count; i++) {
        if (g.leader[i] != i) continue;
        ProposedLine line = line_of(&g, i, is_light);
        if (line.characters < 2) continue;
        add_dots(&g, &line);
        lines[found++] = line;
    }
    *out = lines;
    return found;
}

#define LEVELS 15
#define MARGIN 0.15 /* of the characters' height */

/* The lines of one level and polarity. */
typedef struct FoundLines {
    ProposedLine *line;
    int count;
} FoundLines;

/* The root of luminance is nearer to perceived lightness: dim text counts too. */
static float *lightness_of(const ContentLight *light, Arena *arena) {
    size_t all = (size_t)light->width * (size_t)light->height;
    float *lightness = ARENA_NEW(arena, float, all), most = 0;
    for (size_t i = 0; i < all; i++) most = fmaxf(most, light->cd_m2[i]);
    for (size_t i = 0; i < all && most > 0; i++) lightness[i] = sqrtf(light->cd_m2[i] / most);
    return lightness;
}

static FoundLines lines_of_layer(const TextLayer *layer, Arena *arena) {
    Arena scratch = *arena;
    TextPart *parts;
    FoundLines found;
    int count = text_parts(layer, &scratch, &parts);
    found.count = text_lines(parts, count, layer->is_light, &scratch, &found.line);
    found.line = arena_keep(arena, found.line, sizeof(ProposedLine) * (size_t)found.count,
                            _Alignof(ProposedLine));
    return found;
}

/* ---- which to keep ----------------------------------------------------------------------- */

static int by_place(const ProposedLine *a, const ProposedLine *b) {
    return a->top != b->top     ? a->top - b->top
           : a->left != b->left ? a->left - b->left
                                : a->right - b->right;
}

static int by_weight(const void *a, const void *b) {
    const ProposedLine *p = a, *q = b;
    return p->weight != q->weight ? (p->weight < q->weight) - (p->weight > q->weight)
                                  : by_place(p, q);
}

static int by_height(const void *a, const void *b) {
    const ProposedLine *p = a, *q = b;
    return p->height != q->height ? q->height - p->height : by_place(p, q);
}

static double area(int left, int top, int right, int bottom) {
    return right < left || bottom < top ? 0 : (right - left + 1.0) * (bottom - top + 1.0);
}

/* Does one cover more than half of the other? */
static bool overlap(const ProposedLine *a, const ProposedLine *b) {
    double shared = area(a->left > b->left ? a->left : b->left, a->top > b->top ? a->top : b->top,
                         a->right < b->right ? a->right : b->right,
                         a->bottom < b->bottom ? a->bottom : b->bottom);
    return 2 * shared > fmin(area(a->left, a->top, a->right, a->bottom),
                             area(b->left, b->top, b->right, b->bottom));
}

/* Heaviest first; sorted in place, the kept ones in front. */
static int keep_apart(ProposedLine *lines, int count) {
    int kept = 0;
    qsort(lines, (size_t)count, sizeof *lines, by_weight);
    for (int i = 0; i < count; i++) {
        bool is_new = true;
        for (int j = 0; j < kept && is_new; j++) is_new = !overlap(&lines[i], &lines[j]);
        if (is_new) lines[kept++] = lines[i];
    }
    return kept;
}

static TextProposal proposal_of(const ContentLight *light, const ProposedLine *line) {
    int margin = (int)ceil(MARGIN * line->height);
    int left = line->left - margin, top = line->top - margin;
    int right = line->right + 1 + margin, bottom = line->bottom + 1 + margin;
    if (left < 0) left = 0;
    if (top < 0) top = 0;
    if (right > light->width) right = light->width;
    if (bottom > light->height) bottom = light->height;
    return (TextProposal){{(double)(light->x + left) / light->content_width,
                           (double)(light->y + top) / light->content_height,
                           (double)(light->x + right) / light->content_width,
                           (double)(light->y + bottom) / light->content_height},
                          line->is_light,
                          line->height,
                          line->characters};
}

int text_find(const ContentLight *light, int most, Arena *arena, TextProposal **out) {
    TextProposal *proposals = ARENA_NEW(arena, TextProposal, most);
    Arena scratch = *arena;
    TextLayer layer = {light->width, light->height, lightness_of(light, &scratch), 0, false};
    FoundLines found[2 * LEVELS];
    int all = 0, count = 0;
    for (int i = 0; i < 2 * LEVELS; i++) {
        layer.threshold = (float)(i / 2 + 1) / (LEVELS + 1);
        layer.is_light = i % 2 == 0;
        found[i] = lines_of_layer(&layer, &scratch);
        all += found[i].count;
    }
    ProposedLine *lines = ARENA_NEW(&scratch, ProposedLine, all);
    for (int i = 0; i < 2 * LEVELS; i++)
        for (int k = 0; k < found[i].count; k++) lines[count++] = found[i].line[k];
    count = keep_apart(lines, count);
    qsort(lines, (size_t)count, sizeof *lines, by_height);
    if (count > most) count = most;
    for (int i = 0; i < count; i++) proposals[i] = proposal_of(light, &lines[i]);
    *out = proposals;
    return count;
}
