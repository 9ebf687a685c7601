/* SPDX-License-Identifier: Apache-2.0 */
/* planes.h -- three planes of linear light, however the picture was stored.
 *
 * Units    linear Rec.709: cd m^-2 for frames, 0 .. 1 of the display's white for pictures.
 * Layout   row 0 at the top, pixel (x, y) at y * width + x.
 * Memory   a view: the planes belong to their creator.
 */
#pragma once
#include <stddef.h>

typedef struct Planes {
    int width, height; /* at least 1 */
    const float *rgb[3];
} Planes;

static inline size_t planes_pixel_count(const Planes *planes) {
    return (size_t)planes->width * (size_t)planes->height;
}

/* Which pixels count: one byte each, 0 leaves it out; NULL: all do. */
typedef const unsigned char *PixelMask;
