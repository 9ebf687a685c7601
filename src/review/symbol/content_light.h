/* SPDX-License-Identifier: Apache-2.0 */
/* content_light.h -- the luminances of the pixels that a display shows within a rectangle of
 * its content: what the panel sends along its normal for each pixel's codes.
 *
 * uv       of the content: u right, v down, 0..1; a pixel belongs to a rectangle that holds its
 *          centre. A display without content shows one white pixel.
 * Units    cd m^-2, at level 1.
 * Memory   from the arena; the content must outlive the result.  Threads  pure functions.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"
#include "image/image.h"
#include "panel/query/panel.h"

/* Pixels x .. x + width - 1, y .. y + height - 1 of the content, row by row. */
typedef struct ContentLight {
    const Image *content;              /* NULL: white */
    int content_width, content_height; /* 1 x 1 without content */
    int x, y, width, height;
    float *cd_m2;
} ContentLight;

/* uv: left, top, right, bottom. Fails when it leaves 0..1, is not left < right and top <
 * bottom, or holds no pixel's centre; the text does not name the rectangle's owner. */
bool content_light(const Panel *panel, const Image *content, const double uv[4], Arena *arena,
                   ContentLight *out, Error *err);

/* Codes of a pixel of the content, 0..255. */
void content_codes(const Image *content, int x, int y, float rgb[3]);

/* The connected parts of a set of pixels: eight neighbours belong together.
 *
 * Memory   from the arena.  Threads  pure function. */

/* First and last pixel of each axis. */
typedef struct ConnectedPart {
    int left, top, right, bottom;
    long pixels;
} ConnectedPart;

typedef struct ConnectedParts {
    ConnectedPart *part; /* in the order of their first pixels, row by row */
    int count;
    int32_t *part_of; /* of each pixel; -1: not in the set */
} ConnectedParts;

/* set: width * height, row by row, not 0 where a pixel is in it. At most 2^31 pixels. */
ConnectedParts connected_parts(const uint8_t *set, int width, int height, Arena *arena);
