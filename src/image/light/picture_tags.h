/* SPDX-License-Identifier: Apache-2.0 */
/* picture_tags.h -- what a picture's file states of how its codes are shown: which way up, and
 * which light they mean.
 *
 * Read     PNG: cICP, iCCP, sRGB, gAMA, cHRM (the first of these that is there counts), eXIf;
 *          JPEG and WebP: ICC profile, Exif's orientation; TIFF: both; DPX: transfer and
 *          primaries. (PNG, third edition;
 *          ICC.1:2022; Exif 2.32; ITU-T H.273.) Profiles of a matrix and curves, or of one
 *          curve for greys, are understood; tables and others (CMYK), PQ and HLG are not.
 *          What is sRGB within what 8 bits can show is sRGB; so is a gAMA of 1/2.2 by itself.
 * Units    codes 0 .. 1; light linear, 1 is the picture's white, which is taken for D65.
 * Memory   from the arena. Threads: pure functions. Fails: never; what is damaged is not known.
 */
#pragma once
#include "image/colour.h"
#include "image/light/icc_read.h"
#include "image/image.h"

typedef struct PictureTags {
    int orientation;   /* as Exif has it, 1 to 8; 1 is upright */
    const char *words; /* what is stated of colours, "" for sRGB and for nothing */
    bool is_srgb;      /* or states nothing */
    uint64_t digest;   /* of what is stated of colours, as it stands in the file */
    bool is_known;     /* sRGB, or by this: */
    IccLight light;
} PictureTags;

PictureTags picture_tags_read(const void *bytes, size_t size, Arena *arena);

/* "orientation 6, an ICC profile ..."; "" for an upright sRGB picture. */
const char *picture_tags_text(const PictureTags *tags, Arena *arena);

/* The picture the right way up, in the arena; itself where it is. */
Image picture_upright(const Image *image, int orientation, Arena *arena);
