/* SPDX-License-Identifier: Apache-2.0 */
/* plain_jpeg.h -- decodes the commonest photographs at once: JPEG files of 8 bits that are grey
 * or of three components.
 *
 * Anything unusual about a file, damage above all, makes it not plain: it is then for the
 * library for all pictures (openimageio/image_file.h), which takes a fifth of a second and some
 * threads to load, and its reasons. Plain files have the same pixels by either.
 *
 * By libjpeg.
 * Threads  no state. Memory: the caller's, and libjpeg's own while it reads.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct PlainJpeg {
    const unsigned char *bytes; /* the file */
    size_t size;
    int width, height; /* 1 to 65535 */
} PlainJpeg;

/* False: not plain. */
bool plain_jpeg_open(const unsigned char *bytes, size_t size, PlainJpeg *out);

/* rgba: 4 * width * height bytes, from the top; grey counts as all three colours, alpha is 255.
 * False: not plain after all. */
bool plain_jpeg_read(const PlainJpeg *jpeg, unsigned char *rgba);
