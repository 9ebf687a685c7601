/* SPDX-License-Identifier: Apache-2.0 */
/* connected.h -- the connected parts of a set of pixels: eight neighbours belong together.
 *
 * Memory   from the arena.  Threads  pure function.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"

/* First and last pixel of each axis. */
typedef struct ConnectedPart {
    int  left, top, right, bottom;
    long pixels;
} ConnectedPart;

typedef struct ConnectedParts {
    ConnectedPart *part; /* in the order of their first pixels, row by row */
    int            count;
    int32_t       *part_of; /* of each pixel; -1: not in the set */
} ConnectedParts;

/* set: width * height, row by row, not 0 where a pixel is in it. At most 2^31 pixels. */
ConnectedParts connected_parts(const uint8_t *set, int width, int height, Arena *arena);
