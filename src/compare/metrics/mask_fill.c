/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/mask_fill.h"

#include <stdbool.h>
#include <string.h>

/* The nearest column of a row that counts for each column; false when none does. */
static bool nearest_columns(const unsigned char *mask, int width, int *nearest)
{
    int last = -1;
    for (int x = 0; x < width; x++) {
        if (mask[x]) last = x;
        nearest[x] = last;
    }
    if (last < 0) return false;
    for (int x = width - 1, next = -1; x >= 0; x--) {
        if (mask[x]) next = x;
        if (next >= 0 && (nearest[x] < 0 || next - x < x - nearest[x])) nearest[x] = next;
    }
    return true;
}

/* Rows that have no values take those of the nearest row that has. */
static void fill_rows(float *plane, const bool *has, int width, int height)
{
    for (int y = 0; y < height; y++) {
        int above = y, below = y;
        while (above >= 0 && !has[above]) above--;
        while (below < height && !has[below]) below++;
        int from = above < 0 || (below < height && below - y < y - above) ? below : above;
        if (from != y && from < height)
            memcpy(plane + (size_t)y * (size_t)width, plane + (size_t)from * (size_t)width,
                   (size_t)width * sizeof *plane);
    }
}

static bool all_count(const Planes *picture, PixelMask mask)
{
    return !mask || !memchr(mask, 0, planes_pixel_count(picture));
}

Planes mask_fill(const Planes *picture, PixelMask mask, Arena *arena)
{
    Planes out = *picture;
    int    width = out.width;
    if (all_count(picture, mask)) return out;
    float *plane[3];
    for (int c = 0; c < 3; c++)
        out.rgb[c] = plane[c] = ARENA_NEW(arena, float, planes_pixel_count(picture));
    bool *has = ARENA_NEW(arena, bool, out.height);
    int  *nearest = ARENA_NEW(arena, int, width);
    for (int y = 0; y < out.height; y++) {
        size_t row = (size_t)y * (size_t)width;
        has[y] = nearest_columns(mask + row, width, nearest);
        for (int x = 0; has[y] && x < width; x++)
            for (int c = 0; c < 3; c++)
                plane[c][row + (size_t)x] = picture->rgb[c][row + (size_t)nearest[x]];
    }
    for (int c = 0; c < 3; c++) fill_rows(plane[c], has, width, out.height);
    return out;
}
