/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/text_lines.h"

#include <math.h>

/* How unlike two neighbours of a line may be, and how far from each other. */
#define HEIGHTS 1.8
#define STROKES 1.8
#define LIGHTNESS 0.15
#define GAP 0.8          /* of the taller's height */
#define DOT_GAP 0.5      /* of the line's height */

typedef struct Grouping {
    const TextPart *parts;
    int  count;
    int *leader; /* of each part, itself or another of its line; -1: in no line */
} Grouping;

static int height_of(const TextPart *p)
{
    return p->bottom - p->top + 1;
}

/* In rows; 0 or less: they share none. */
static int shared_height(const TextPart *a, const TextPart *b)
{
    int top = a->top > b->top ? a->top : b->top;
    int bottom = a->bottom < b->bottom ? a->bottom : b->bottom;
    return bottom - top + 1;
}

/* b begins no further left than a. */
static bool are_neighbours(const TextPart *a, const TextPart *b)
{
    int    low = height_of(a) < height_of(b) ? height_of(a) : height_of(b);
    int    high = height_of(a) + height_of(b) - low;
    double thin = fmin(a->stroke_px, b->stroke_px), broad = fmax(a->stroke_px, b->stroke_px);
    int    least_width = a->right - a->left < b->right - b->left ? a->right - a->left
                                                                  : b->right - b->left;
    int    gap = b->left - a->right;
    return gap <= GAP * high && 2 * gap >= -least_width && high <= HEIGHTS * low &&
           2 * shared_height(a, b) >= low && broad <= STROKES * thin &&
           fabs(a->lightness - b->lightness) <= LIGHTNESS;
}

static int leader_of(const Grouping *g, int i)
{
    while (g->leader[i] != i) i = g->leader[i];
    return i;
}

static void join(const Grouping *g, int widest_gap)
{
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

static void widen(ProposedLine *line, const TextPart *p)
{
    if (p->left < line->left) line->left = p->left;
    if (p->top < line->top) line->top = p->top;
    if (p->right > line->right) line->right = p->right;
    if (p->bottom > line->bottom) line->bottom = p->bottom;
}

static ProposedLine line_of(const Grouping *g, int leader, bool is_light)
{
    const TextPart *first = &g->parts[leader];
    ProposedLine line = {first->left, first->top, first->right, first->bottom, 0, 0, 0,
                         is_light};
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
static void add_dots(const Grouping *g, ProposedLine *line)
{
    ProposedLine bare = *line;
    int      gap = (int)(DOT_GAP * line->height), over = line->height / 4;
    for (int i = 0; i < g->count; i++) {
        const TextPart *p = &g->parts[i];
        if (p->left > bare.right + gap) break;
        if (g->leader[i] < 0 && 2 * height_of(p) <= line->height &&
            2 * (p->right - p->left) <= line->height && p->right >= bare.left - gap &&
            p->top >= bare.top - over && p->bottom <= bare.bottom + over)
            widen(line, p);
    }
}

int text_lines(const TextPart *parts, int count, bool is_light, Arena *arena,
               ProposedLine **out)
{
    Grouping  g = {parts, count, ARENA_NEW(arena, int, count)};
    ProposedLine *lines = ARENA_NEW(arena, ProposedLine, count);
    int       found = 0, tallest = 0;
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
