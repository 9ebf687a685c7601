/* SPDX-License-Identifier: Apache-2.0 */
/* light_shares.h -- how much of the light of a part of a frame each group of lights gives.
 *
 * Memory   the list and its names come from the arena.
 * Threads  pure functions.
 */
#pragma once
#include "measure/measure.h"

/* The contribution of one group of lights to a part of a frame. */
typedef struct LightShare {
    const char *layer; /* "light.sun" */
    const char *name;  /* as its scene has it */
    double cd_m2;      /* of the part's luminance: its share of it */
    double share;      /* of all light there; 0 where there is none */
} LightShare;

typedef struct LightShares {
    LightShare *list; /* the brightest first */
    int count;        /* 0: the frame has no layers of lights */
    long pixels;      /* that shares are of: of a display those that show it alone */
} LightShares;

/* For a request that measure_frame answers, over the pixels that it takes; of a display only
 * over those that show nothing else, as far as the frame shows (display.coverage). luminance:
 * the answer's, cd m^-2, to which what the groups give adds up. */
LightShares light_shares_measure(const FrameImage *frame, const MeasureRequest *request,
                                 double luminance, Arena *arena);
