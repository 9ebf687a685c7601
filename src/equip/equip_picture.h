/* SPDX-License-Identifier: Apache-2.0 */
/* equip_picture.h -- small pictures for the page of `parhelion equip`, as data: URIs.
 *
 * Memory   scratch is the caller's; the JSON value is jansson's. Threads: any.
 * Fails    never: NULL where the image is no usual picture.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "image/image.h"

#define THUMB_PIXELS 512 /* a picture's longer side */

typedef struct PixelBox {
    int left, top, right, bottom; /* right and bottom behind the last */
} PixelBox;

typedef struct PixelSize {
    int width, height;
} PixelSize;

/* All of it. */
PixelBox equip_picture_box(const Image *image);

/* A part of an image, made `size` large; every pixel is the mean of those it covers. */
json_t *equip_picture_json(const Image *image, PixelBox part, PixelSize size, Arena scratch);
