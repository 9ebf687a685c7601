/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/text_find.h"

#include <math.h>
#include <stdlib.h>

#include "review/symbol/text_lines.h"

#define LEVELS 15
#define MARGIN 0.15 /* of the characters' height */

/* The lines of one level and polarity. */
typedef struct FoundLines {
    ProposedLine *line;
    int       count;
} FoundLines;

/* The root of luminance is nearer to perceived lightness: dim text counts too. */
static float *lightness_of(const ContentLight *light, Arena *arena)
{
    size_t all = (size_t)light->width * (size_t)light->height;
    float *lightness = ARENA_NEW(arena, float, all), most = 0;
    for (size_t i = 0; i < all; i++) most = fmaxf(most, light->cd_m2[i]);
    for (size_t i = 0; i < all && most > 0; i++) lightness[i] = sqrtf(light->cd_m2[i] / most);
    return lightness;
}

static FoundLines lines_of_layer(const TextLayer *layer, Arena *arena)
{
    Arena      scratch = *arena;
    TextPart  *parts;
    FoundLines found;
    int count = text_parts(layer, &scratch, &parts);
    found.count = text_lines(parts, count, layer->is_light, &scratch, &found.line);
    found.line = arena_keep(arena, found.line, sizeof(ProposedLine) * (size_t)found.count,
                            _Alignof(ProposedLine));
    return found;
}

/* ---- which to keep ----------------------------------------------------------------------- */

static int by_place(const ProposedLine *a, const ProposedLine *b)
{
    return a->top != b->top     ? a->top - b->top
           : a->left != b->left ? a->left - b->left
                                : a->right - b->right;
}

static int by_weight(const void *a, const void *b)
{
    const ProposedLine *p = a, *q = b;
    return p->weight != q->weight ? (p->weight < q->weight) - (p->weight > q->weight)
                                  : by_place(p, q);
}

static int by_height(const void *a, const void *b)
{
    const ProposedLine *p = a, *q = b;
    return p->height != q->height ? q->height - p->height : by_place(p, q);
}

static double area(int left, int top, int right, int bottom)
{
    return right < left || bottom < top ? 0 : (right - left + 1.0) * (bottom - top + 1.0);
}

/* Does one cover more than half of the other? */
static bool overlap(const ProposedLine *a, const ProposedLine *b)
{
    double shared = area(a->left > b->left ? a->left : b->left,
                         a->top > b->top ? a->top : b->top,
                         a->right < b->right ? a->right : b->right,
                         a->bottom < b->bottom ? a->bottom : b->bottom);
    return 2 * shared > fmin(area(a->left, a->top, a->right, a->bottom),
                             area(b->left, b->top, b->right, b->bottom));
}

/* Heaviest first; sorted in place, the kept ones in front. */
static int keep_apart(ProposedLine *lines, int count)
{
    int kept = 0;
    qsort(lines, (size_t)count, sizeof *lines, by_weight);
    for (int i = 0; i < count; i++) {
        bool is_new = true;
        for (int j = 0; j < kept && is_new; j++) is_new = !overlap(&lines[i], &lines[j]);
        if (is_new) lines[kept++] = lines[i];
    }
    return kept;
}

static TextProposal proposal_of(const ContentLight *light, const ProposedLine *line)
{
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
                          line->is_light, line->height, line->characters};
}

int text_find(const ContentLight *light, int most, Arena *arena, TextProposal **out)
{
    TextProposal *proposals = ARENA_NEW(arena, TextProposal, most);
    Arena      scratch = *arena;
    TextLayer  layer = {light->width, light->height, lightness_of(light, &scratch), 0, false};
    FoundLines found[2 * LEVELS];
    int        all = 0, count = 0;
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
