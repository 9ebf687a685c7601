/* SPDX-License-Identifier: Apache-2.0 */
/* image_file_types.h -- what is known of a picture file, and what is to become one.
 * image_file.h has the functions on them.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef enum PixelType { PIXEL_U8, PIXEL_U16, PIXEL_F32 } PixelType;

typedef struct ImageFileInfo {
    int width, height;
    int channels;      /* that image_decoder_read delivers: 1 .. 4 */
    int alpha_channel; /* 0 .. 3, or -1 */
    PixelType type;    /* the smallest that holds the file's values */
} ImageFileInfo;

typedef struct ImageDecoder ImageDecoder; /* owns a C++ object */

/* A picture to be encoded. U8 and U16 only. */
typedef struct ImageToEncode {
    int width, height;
    int channels; /* 1 grey, 3 RGB, 4 RGB and straight alpha */
    PixelType type;
    const void *pixels;
    int jpeg_quality;        /* 1 .. 100 for "jpeg", else 0 */
    bool is_srgb;            /* the file states that its codes are sRGB (not a TIFF) */
    const void *icc_profile; /* valid, or NULL */
    size_t icc_profile_size;
    const char *description; /* a text that goes into the file, or NULL */
} ImageToEncode;

typedef struct EncodedImage EncodedImage; /* owns bytes */
