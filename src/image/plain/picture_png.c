/* SPDX-License-Identifier: Apache-2.0 */
#include "image/plain/picture_png.h"

#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

enum { LEVEL = 6, FIRST_BYTES = 1 << 16 };

/* Bytes that follow each other, the arena's last; libpng has memory of its own meanwhile. */
typedef struct PngSink {
    Arena *arena;
    unsigned char *bytes;
    size_t size, room;
} PngSink;

static void put(png_structp png, png_bytep bytes, size_t size) {
    PngSink *sink = png_get_io_ptr(png);
    size_t room = sink->room ? sink->room : FIRST_BYTES;
    while (room <= sink->size + size) room *= 2;
    if (room > sink->room)
        sink->bytes = ARENA_GROW(sink->arena, unsigned char, sink->bytes, sink->room, room);
    sink->room = room;
    memcpy(sink->bytes + sink->size, bytes, size);
    sink->size += size;
}

static void flush(png_structp png) {
    (void)png;
}

static void keep_words(png_structp png, png_const_charp words) {
    error_set(png_get_error_ptr(png), ERROR_LIBRARY, "encoding a png picture: %s", words);
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp words) {
    (void)png;
    (void)words;
}

static void add_text(png_structp png, png_infop info, const char *key, const char *text) {
    png_text one = {.compression = PNG_TEXT_COMPRESSION_NONE,
                    .key = (char *)(uintptr_t)key, /* libpng copies both */
                    .text = (char *)(uintptr_t)text};
    png_set_text(png, info, &one, 1);
}

static void describe(png_structp png, png_infop info, const ImageToEncode *image) {
    static const int colours[] = {0, PNG_COLOR_TYPE_GRAY, 0, PNG_COLOR_TYPE_RGB,
                                  PNG_COLOR_TYPE_RGBA};
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height,
                 image->type == PIXEL_U8 ? 8 : 16, colours[image->channels], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_oFFs(png, info, 0, 0, PNG_OFFSET_PIXEL);
    if (image->is_srgb) png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
    if (image->icc_profile)
        png_set_iCCP(png, info, "Embedded Profile", PNG_COMPRESSION_TYPE_BASE, image->icc_profile,
                     (png_uint_32)image->icc_profile_size);
    add_text(png, info, "Software", "parhelion");
    if (image->description) add_text(png, info, "Description", image->description);
    if (image->is_srgb) add_text(png, info, "oiio:ColorSpace", "sRGB");
}

static bool write_all(png_structp png, png_infop info, const ImageToEncode *image) {
    size_t row = (size_t)image->width * (size_t)image->channels * (image->type == PIXEL_U8 ? 1 : 2);
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_compression_level(png, LEVEL);
    png_set_compression_strategy(png, Z_DEFAULT_STRATEGY);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_NO_FILTERS);
    describe(png, info, image);
    png_write_info(png, info);
    if (image->type == PIXEL_U16) png_set_swap(png);
    for (int y = 0; y < image->height; y++)
        png_write_row(png, (const unsigned char *)image->pixels + (size_t)y * row);
    png_write_end(png, info);
    return true;
}

bool picture_png_encode(const ImageToEncode *image, Arena *arena, FileBytes *out, Error *err) {
    PngSink sink = {.arena = arena};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, err, keep_words, ignore);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        return error_set(err, ERROR_MEMORY, "encoding a png picture: out of memory");
    }
    png_set_write_fn(png, &sink, put, flush);
    bool ok = write_all(png, info, image);
    png_destroy_write_struct(&png, &info);
    if (ok) *out = (FileBytes){sink.bytes, sink.size};
    return ok;
}
