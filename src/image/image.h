/* SPDX-License-Identifier: Apache-2.0 */
/* image.h -- pixels with named channels and a unit.
 *
 * Layout   row 0 at the top, pixels left to right, channels interleaved.
 * Memory   pixels come from the arena that is passed in; nothing to free.
 * Threads  plain data.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "base/error.h"

/* A decoded picture for textures and contents: always four channels, straight alpha. */
typedef enum ImageFormat {
    IMAGE_RGBA8,  /* codes 0..255 */
    IMAGE_RGBA16, /* codes 0..65535 */
    IMAGE_RGBA32F /* linear floats (HDR pictures) */
} ImageFormat;

typedef struct Image {
    int width, height; /* 1 .. 65536 */
    ImageFormat format;
    const void *pixels; /* width * height * 4 values; missing alpha is full */
} Image;

/* Decodes PNG, JPEG, EXR, HDR, TIFF ... `name` is for messages, and its ending a hint.
 * Grey becomes R = G = B; alpha stays straight. Negative or non-finite floats are kept. A code
 * of a Radiance picture stands for the middle of its step, as in Radiance's tools. A file of
 * several pages or frames (picture_pages.h), or with channels that are neither colour nor
 * alpha, is refused. */
bool image_read(const char *path, Arena *arena, Image *out, Error *err);
bool image_read_memory(const void *bytes, size_t size, const char *name, Arena *arena, Image *out,
                       Error *err);

/* The first page alone, for who looks at the others. */
bool image_read_first(const void *bytes, size_t size, const char *name, Arena *arena, Image *out,
                      Error *err);
