/* SPDX-License-Identifier: Apache-2.0 */
/* plain_png.h -- decodes the commonest pictures at once: PNG files of 8 bits that are grey or
 * RGB, with or without alpha, and those with a palette; not interlaced, without a transparent
 * colour.
 *
 * Anything unusual about a file, damage above all, makes it not plain: it is then for the
 * library for all pictures (openimageio/image_file.h), which takes a fifth of a second to load,
 * and its reasons.
 *
 * A file of another kind that is damaged is known here too, since that library prints a line of
 * its own about it.
 *
 * By libpng.
 * Threads  no state. Memory: the caller's, and libpng's own while it reads: some rows.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#define PNG_WHY_BYTES 128

typedef struct PlainPng {
    const unsigned char *bytes; /* the file: whole, with the right checksums */
    size_t size;
    int width, height; /* 1 to 65536 */
} PlainPng;

/* False: not plain. */
bool plain_png_open(const unsigned char *bytes, size_t size, PlainPng *out);

/* Whether a file of any kind decodes to its end; one of more than `most_pixels` is not decoded
 * beyond its head. False: `why` has libpng's words. */
bool png_is_sound(const unsigned char *bytes, size_t size, double most_pixels,
                  char why[static PNG_WHY_BYTES]);

/* rgba: 4 * width * height bytes, from the top; grey counts as all three colours, without alpha
 * it is 255. False: not plain after all. */
bool plain_png_read(const PlainPng *png, unsigned char *rgba);
