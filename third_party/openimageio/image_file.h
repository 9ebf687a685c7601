/* image_file.h -- decodes and encodes picture files in memory.
 * The only C view of OpenImageIO in this program.
 *
 * Layout   row 0 at the top, channels interleaved.
 * Memory   a decoder and encoded bytes are handles with a destroy; pixels belong to the caller.
 * Threads  one handle belongs to one thread at a time.
 * Fails    with the library's reason; no file is touched here.
 */
#pragma once
#include <stddef.h>

#include "base/error.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef enum PixelType { PIXEL_U8, PIXEL_U16, PIXEL_F32 } PixelType;

typedef struct ImageFileInfo {
    int       width, height;
    int       channels;      /* that image_decoder_read delivers: 1 .. 4 */
    int       alpha_channel; /* 0 .. 3, or -1 */
    PixelType type;          /* the smallest that holds the file's values */
} ImageFileInfo;

typedef struct ImageDecoder ImageDecoder; /* owns a C++ object */

/* format: the library's name ("png", "jpeg", "tiff", "hdr", "bmp", "webp", "targa" ...).
 * bytes stay with the caller and must outlive the decoder. name is for messages only. */
bool image_decoder_create(const char *format, const char *name, const void *bytes, size_t size,
                          ImageDecoder **out, Error *err);

ImageFileInfo image_decoder_info(const ImageDecoder *decoder);

/* pixels: width * height * channels values of info.type. Alpha is straight. */
bool image_decoder_read(ImageDecoder *decoder, void *pixels, Error *err);

void image_decoder_destroy(ImageDecoder *decoder); /* NULL is fine */

/* What is to be encoded. U8 and U16 only. */
typedef struct ImageToEncode {
    int         width, height;
    int         channels; /* 1 grey, 3 RGB, 4 RGB and straight alpha */
    PixelType   type;
    const void *pixels;
    int         jpeg_quality;       /* 1 .. 100 for "jpeg", else 0 */
    bool        is_srgb;            /* the file says that its codes are sRGB (not a TIFF) */
    const void *icc_profile;        /* valid, or NULL */
    size_t      icc_profile_size;
    const char *description;        /* a text that goes into the file, or NULL */
} ImageToEncode;

typedef struct EncodedImage EncodedImage; /* owns bytes */

/* format: "png", "jpeg" or "tiff". The same input gives the same bytes. */
bool image_encode(const char *format, const ImageToEncode *image, EncodedImage **out,
                  Error *err);

const void *encoded_image_bytes(const EncodedImage *encoded, size_t *size);
void encoded_image_destroy(EncodedImage *encoded); /* NULL is fine */

#ifdef __cplusplus
}
#endif
