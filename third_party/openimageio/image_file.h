/* SPDX-License-Identifier: Apache-2.0 */
/* image_file.h -- decodes and encodes picture files in memory.
 * The only C view of OpenImageIO in this program, which loads it when one of these is called
 * (image_file_module.h).
 *
 * Layout   row 0 at the top, channels interleaved.
 * Memory   a decoder and encoded bytes are handles with a destroy; pixels belong to the caller.
 * Threads  one handle belongs to one thread at a time.
 * Fails    with the library's reason; no file is touched here.
 */
#pragma once
#include "base/error.h"
#include "openimageio/image_file_types.h"

/* Where address space is limited (ulimit -v) and there is enough of it, the library is loaded
 * now, before arenas share out the rest; else when it is first asked for. */
void image_file_take_share(void);

/* format: the library's name ("png", "jpeg", "tiff", "hdr", "bmp", "webp", "targa" ...).
 * bytes stay with the caller and must outlive the decoder. name is for messages only. */
bool image_decoder_create(const char *format, const char *name, const void *bytes, size_t size,
                          ImageDecoder **out, Error *err);

ImageFileInfo image_decoder_info(const ImageDecoder *decoder);

/* pixels: width * height * channels values of info.type. Alpha is straight. */
bool image_decoder_read(ImageDecoder *decoder, void *pixels, Error *err);

void image_decoder_destroy(ImageDecoder *decoder); /* NULL is fine */

/* format: "jpeg" or "tiff" (a PNG: image/plain/picture_png.h). The same input gives the same
 * bytes. */
bool image_encode(const char *format, const ImageToEncode *image, EncodedImage **out, Error *err);

const void *encoded_image_bytes(const EncodedImage *encoded, size_t *size);
void encoded_image_destroy(EncodedImage *encoded); /* NULL is fine */
