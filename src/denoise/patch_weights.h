/* SPDX-License-Identifier: Apache-2.0 */
/* patch_weights.h -- how alike the pixels around are: non-local means over patches.
 *
 * One half's light gives the weights with which the other is filtered, so that noise does not
 * choose itself (Rousselle, Knaus and Zwicker 2012).
 *
 * Layout   a tile of PATCH_TILE x PATCH_TILE pixels; each pixel has a weight for every place
 *          of a window of PATCH_WINDOW x PATCH_WINDOW around it.
 * Threads  a tile and its scratch belong to one thread.
 */
#pragma once
#include "denoise/buffers.h"

enum {
    PATCH_REACH = 3,   /* a patch is 7 x 7 */
    PATCH_SEARCH = 9,  /* the window 19 x 19 */
    PATCH_WINDOW = 2 * PATCH_SEARCH + 1,
    PATCH_OFFSETS = PATCH_WINDOW * PATCH_WINDOW,
    PATCH_TILE = 34,
    PATCH_SIDE = PATCH_TILE + 2 * PATCH_REACH, /* the tile and what its patches need */
    PATCH_WIDE = PATCH_SIDE + 2 * PATCH_SEARCH /* and what its windows need */
};

typedef struct PatchScratch PatchScratch;

PatchScratch *patch_scratch_create(Arena *arena);

/* The pictures whose patches are held against each other. */
typedef struct PatchGuide {
    const DenoiseBuffers *buffers;
    const float          *light[2][3];  /* of each half */
    const float          *variance[3];  /* of the mean of both halves' light */
    float                 strength;     /* how fast unlike patches stop to count */
} PatchGuide;

/* Weights for filtering the half `filtered` of the tile whose first pixel is x0, y0, in
 * [0, 1]: weights[pixel of the tile][offset]; 0 where there is no pixel or one of another
 * kind. */
void patch_weights(const PatchGuide *guide, int filtered, int x0, int y0,
                   PatchScratch *scratch, float (*weights)[PATCH_OFFSETS]);
