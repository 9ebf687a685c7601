/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/symbol_shape.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/sort.h"
#include "base/vec.h"
#include "review/symbol/connected.h"

/* Wider edges than this are no edges: a glow. */
#define EDGE_PIXELS 2

static float share_at(const SymbolDrawing *d, int x, int y)
{
    if (x < 0 || y < 0 || x >= d->width || y >= d->height) return 0;
    return d->share[(size_t)y * (size_t)d->width + (size_t)x];
}

/* Sorts the values; count: at least 1. */
static double median(float *values, long count)
{
    sort_floats(values, count);
    return 0.5 * ((double)values[(count - 1) / 2] + (double)values[count / 2]);
}

/* ---- extent ------------------------------------------------------------------------------ */

/* The greatest share of a line of pixels: column x from `first` to `last`, or row x. */
static double most_of_line(const SymbolDrawing *d, bool is_column, int at, int first, int last)
{
    float most = 0;
    for (int i = first; i <= last; i++)
        most = fmaxf(most, is_column ? share_at(d, at, i) : share_at(d, i, at));
    return (double)most;
}

/* How far the edge reaches beyond the line `at` of whole pixels, going by `step`. */
static double edge_beyond(const SymbolDrawing *d, bool is_column, int at, int step,
                          const int across[2])
{
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
static bool whole_box(const SymbolDrawing *d, const ConnectedPart *part, ConnectedPart *whole)
{
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

static double top_of(const SymbolDrawing *d, const ConnectedPart *whole)
{
    int across[2] = {whole->left, whole->right};
    return whole->top - edge_beyond(d, false, whole->top, -1, across);
}

static double bottom_of(const SymbolDrawing *d, const ConnectedPart *whole)
{
    int across[2] = {whole->left, whole->right};
    return whole->bottom + 1 + edge_beyond(d, false, whole->bottom, 1, across);
}

static void set_extent(const SymbolDrawing *d, SymbolShape *out)
{
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
    int   step[2][2];
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

static Chords new_chords(const SymbolDrawing *d, Arena *arena)
{
    size_t all = (size_t)d->width * (size_t)d->height;
    return (Chords){{ARENA_NEW(arena, float, all), ARENA_NEW(arena, float, all)}};
}

/* A whole pixel is one more than the chord before it; an edge begins with what is left. */
static float chord_up_to(const SymbolDrawing *d, const float *before, int x, int y,
                         const int from[2])
{
    int   bx = x - from[0], by = y - from[1];
    float own = share_at(d, x, y), outer = share_at(d, bx, by);
    if (own < 1) return own + (outer < own ? outer : 0);
    return outer > 0 ? 1 + before[(size_t)by * (size_t)d->width + (size_t)bx] : 1;
}

/* sign: 1 from the beginning of the way, -1 from its end. What comes before a pixel must be
 * known before it. */
static void add_chords(const SymbolDrawing *d, const ChordWay *way, int sign, Chords *chords)
{
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
static double stroke_width(const SymbolDrawing *d, Arena scratch)
{
    size_t all = (size_t)d->width * (size_t)d->height;
    long   count = 0;
    float *shortest = ARENA_NEW(&scratch, float, all);
    Chords begun = new_chords(d, &scratch), left = new_chords(d, &scratch);
    for (size_t i = 0; i < all; i++) shortest[i] = INFINITY;
    for (int k = 0; k < 4; k++) {
        add_chords(d, &WAYS[k], 1, &begun);
        add_chords(d, &WAYS[k], -1, &left);
        for (size_t i = 0; i < all; i++)
            shortest[i] = fminf(shortest[i], WAYS[k].length *
                                                 (begun.by[0][i] + left.by[1][i] - 1));
    }
    for (size_t i = 0; i < all; i++)
        if (d->share[i] >= 1) shortest[count++] = shortest[i];
    return median(shortest, count);
}

/* ---- characters -------------------------------------------------------------------------- */

/* Pixels that are half drawn hold a character together, and so do gaps of less than a third of
 * its strokes (segments): each pixel also fills so many to the right and below. */
static ConnectedParts characters(const SymbolDrawing *d, int gap, Arena *arena)
{
    int      w = d->width + gap, h = d->height + gap;
    uint8_t *set = ARENA_NEW(arena, uint8_t, (size_t)w * (size_t)h);
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

static bool stands_beside(const ConnectedPart *part, const ConnectedPart *tallest)
{
    int top = part->top > tallest->top ? part->top : tallest->top;
    int bottom = part->bottom < tallest->bottom ? part->bottom : tallest->bottom;
    return 2 * (bottom - top + 1) >= part->bottom - part->top + 1;
}

static double character_height(const SymbolDrawing *d, int gap, Arena scratch)
{
    ConnectedParts parts = characters(d, gap, &scratch);
    ConnectedPart *whole = ARENA_NEW(&scratch, ConnectedPart, parts.count);
    float *heights = ARENA_NEW(&scratch, float, parts.count);
    double most = 0;
    int    tallest = 0;
    long   count = 0;
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

SymbolShape symbol_shape(const SymbolDrawing *drawing, Arena scratch)
{
    SymbolShape shape = {0};
    set_extent(drawing, &shape);
    shape.stroke_px = stroke_width(drawing, scratch);
    shape.character_px = character_height(drawing, (int)(shape.stroke_px / 3), scratch);
    return shape;
}
