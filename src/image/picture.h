/* SPDX-License-Identifier: Apache-2.0 */
/* picture.h -- a finished picture of code values, and its way into a file.
 *
 * Units    code values of some display, 0 .. 1; what lies outside is cut off when written.
 * Layout   row 0 at the top, R, G, B interleaved.
 * Memory   pixels come from the arena that is passed in.
 * Threads  plain data.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "base/file.h"
#include "image/icc_profile.h"

typedef struct Picture {
    int width, height;
    float *rgb; /* width * height * 3 */
} Picture;

/* Black. */
Picture picture_create(int width, int height, Arena *arena);

static inline float *picture_pixel(const Picture *picture, int x, int y) {
    return picture->rgb + ((size_t)y * (size_t)picture->width + (size_t)x) * 3;
}

typedef struct PictureFile {
    int bits;                /* 8 or 16; JPEG has 8 */
    bool is_srgb;            /* stated in the file */
    IccProfile icc;          /* else this does, when there is one */
    const char *description; /* goes into the file; NULL: none */
} PictureFile;

/* PNG, JPEG or TIFF by the name's ending. The same picture gives the same bytes; nothing is
 * left after a failure. Codes are rounded to the nearest, without dither. */
bool picture_write(const char *path, const Picture *picture, PictureFile file, Arena scratch,
                   Error *err);

/* The bytes that picture_write would put into a file of that name, in the arena. */
bool picture_encode(const char *path, const Picture *picture, PictureFile file, Arena *arena,
                    FileBytes *out, Error *err);

/* What a page shows, of 8 bits in sRGB: a JPEG, or a PNG where the library for JPEG cannot be
 * loaded. *kind: "jpeg" or "png". */
bool picture_encode_small(const Picture *picture, Arena *arena, FileBytes *out, const char **kind,
                          Error *err);

/* False, with the endings that are supported, when picture_write would refuse the name or the
 * bits: to be checked before long work. */
bool picture_check_name(const char *path, int bits, Error *err);
