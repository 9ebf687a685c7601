/* SPDX-License-Identifier: Apache-2.0 */
/* text_parts.h -- the connected parts of what is lighter, or darker, than a threshold: which of
 * them may be characters.
 *
 * Units    pixels; lightness 0..1 (text_find.c).
 * Memory   from the arena.  Threads  pure function.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"

/* The pixels above a threshold of lightness, or below it. */
typedef struct TextLayer {
    int          width, height;
    const float *lightness; /* width * height, row by row */
    float        threshold;
    bool         is_light;  /* the parts are above it */
} TextLayer;

typedef struct TextPart {
    int    left, top, right, bottom; /* first and last */
    double stroke_px;    /* 2 area / perimeter */
    double step;         /* mean range of lightness in the 3 x 3 about the pixels of its edge */
    double lightness;    /* mean over its pixels */
    bool   is_character; /* as high, wide, thin and sharp as one; else perhaps a dot */
} TextPart;

/* Those that do not touch the border and are sharp, from left to right. Returns how many. */
int text_parts(const TextLayer *layer, Arena *arena, TextPart **out);
