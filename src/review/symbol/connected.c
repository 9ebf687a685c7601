/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/connected.h"

#include <stddef.h>

#include "base/vec.h"

typedef struct PartSearch {
    const uint8_t *set;
    int      width, height;
    int32_t *part_of, *stack; /* pixels whose neighbours are still to be visited */
    size_t   waiting;
} PartSearch;

static void take(PartSearch *f, int x, int y, int32_t id, ConnectedPart *part)
{
    size_t at = (size_t)y * (size_t)f->width + (size_t)x;
    f->part_of[at] = id;
    f->stack[f->waiting++] = (int32_t)at;
    if (x < part->left) part->left = x;
    if (x > part->right) part->right = x;
    if (y < part->top) part->top = y;
    if (y > part->bottom) part->bottom = y;
    part->pixels++;
}

static bool is_free(const PartSearch *f, int x, int y)
{
    if (x < 0 || y < 0 || x >= f->width || y >= f->height) return false;
    size_t at = (size_t)y * (size_t)f->width + (size_t)x;
    return f->set[at] && f->part_of[at] < 0;
}

static ConnectedPart fill_from(PartSearch *f, int x, int y, int32_t id)
{
    ConnectedPart part = {x, y, x, y, 0};
    take(f, x, y, id, &part);
    while (f->waiting > 0) {
        int32_t at = f->stack[--f->waiting];
        int     px = at % f->width, py = at / f->width;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                if (is_free(f, px + i, py + j)) take(f, px + i, py + j, id, &part);
    }
    return part;
}

static int count_parts(const PartSearch *f)
{
    int    most = 0; /* no more than pixels that begin a run */
    size_t all = (size_t)f->width * (size_t)f->height;
    for (size_t i = 0; i < all; i++)
        most += f->set[i] && (i % (size_t)f->width == 0 || !f->set[i - 1]);
    return most;
}

ConnectedParts connected_parts(const uint8_t *set, int width, int height, Arena *arena)
{
    size_t  all = (size_t)width * (size_t)height;
    PartSearch f = {.set = set, .width = width, .height = height};
    ConnectedParts out = {.part_of = ARENA_NEW(arena, int32_t, all)};
    out.part = ARENA_NEW(arena, ConnectedPart, count_parts(&f));
    Arena scratch = *arena;
    f.part_of = out.part_of;
    f.stack = ARENA_NEW(&scratch, int32_t, all);
    for (size_t i = 0; i < all; i++) f.part_of[i] = -1;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (is_free(&f, x, y)) {
                out.part[out.count] = fill_from(&f, x, y, out.count);
                out.count++;
            }
    return out;
}
