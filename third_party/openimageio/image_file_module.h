/* SPDX-License-Identifier: Apache-2.0 */
/* image_file_module.h -- what image_file.h's functions find in the module of pictures.
 *
 * OpenImageIO brings some 260 shared libraries: 133 MB and a fifth of a second before main. So
 * it is linked into a module of its own, parhelion_pictures.so beside the program, that is
 * loaded when the first picture is read or written; commands without one never see it. The
 * module exports this table.
 */
#pragma once
#include "base/error.h"
#include "openimageio/image_file_types.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct ImageFileModule {
    bool (*decoder_create)(const char *format, const char *name, const void *bytes, size_t size,
                           ImageDecoder **out, Error *err);
    ImageFileInfo (*decoder_info)(const ImageDecoder *decoder);
    bool (*decoder_read)(ImageDecoder *decoder, void *pixels, Error *err);
    void (*decoder_destroy)(ImageDecoder *decoder);
    bool (*encode)(const char *format, const ImageToEncode *image, EncodedImage **out, Error *err);
    const void *(*encoded_bytes)(const EncodedImage *encoded, size_t *size);
    void (*encoded_destroy)(EncodedImage *encoded);
} ImageFileModule;

extern const ImageFileModule image_file_module;

#ifdef __cplusplus
}
#endif
