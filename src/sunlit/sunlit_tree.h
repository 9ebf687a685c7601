/* SPDX-License-Identifier: Apache-2.0 */
/* sunlit_tree.h -- pixels of the sun's plane become a tree of quarters. Private to
 * sunlit_build.c. */
#pragma once
#include "base/arena.h"
#include "sunlit/sunlit_map.h"

#define SUNLIT_FINE 4 /* levels below the first grid, at most */

/* What rays through a pixel showed. */
typedef struct SunlitPixel {
    int landed;     /* rays that a receiver sees; 0: the pixel is no part of the tree */
    float power;    /* of the pixel, relative */
    Vec3 low, high; /* box of the places where they landed, m */
    Vec3 normals;   /* sum of the unit normals, to the sun's side */
    bool both_sides;
} SunlitPixel;

/* Some pixels of the first grid, each a block of 4^fine finer ones. */
typedef struct SunlitGrid {
    int32_t *block_at;   /* of row j and column i, at SUNLIT_SIDE j + i; below 0: none */
    SunlitPixel *pixels; /* block by block, row by row */
    int fine;            /* levels */
    float pitch;         /* m, of a finer pixel's side */
} SunlitGrid;

/* i, j: of the finer grid. NULL: there is none. */
static inline SunlitPixel *sunlit_pixel(const SunlitGrid *grid, int i, int j) {
    int fine = grid->fine, inside = (1 << fine) - 1;
    int block = grid->block_at[(j >> fine) * SUNLIT_SIDE + (i >> fine)];
    if (block < 0) return NULL;
    return &grid->pixels[(block << 2 * fine) + ((j & inside) << fine) + (i & inside)];
}

/* NULL: no pixel has power. */
const SunlitQuarters *sunlit_tree(const SunlitGrid *grid, Arena *arena);
