/* SPDX-License-Identifier: Apache-2.0 */
#include "image/plain/plain_png.h"

#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE_MAX 65536

typedef struct Source {
    const unsigned char *next;
    size_t left;
} Source;

static void take(png_structp png, png_bytep to, size_t count) {
    Source *source = png_get_io_ptr(png);
    if (count > source->left) png_error(png, "cut");
    memcpy(to, source->next, count);
    source->next += count;
    source->left -= count;
}

/* A warning too: the file is not plain, and its faults are the other library's to report. */
static void give_up(png_structp png, png_const_charp why) {
    (void)why;
    png_longjmp(png, 1);
}

static bool read_head(png_structp png, png_infop info, PlainPng *out) {
    uint32_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    bool has_palette = png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE;
    if (width > SIDE_MAX || height > SIDE_MAX ||
        (png_get_bit_depth(png, info) != 8 && !has_palette) ||
        png_get_interlace_type(png, info) != PNG_INTERLACE_NONE ||
        png_get_valid(png, info, PNG_INFO_tRNS | PNG_INFO_sBIT))
        return false;
    out->width = (int)width;
    out->height = (int)height;
    return true;
}

/* What is missing of red, green, blue and alpha the library adds to every row. */
static void read_rows(png_structp png, png_infop info, const PlainPng *file, unsigned char *rgba) {
    png_set_palette_to_rgb(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
    png_read_update_info(png, info);
    for (int y = 0; y < file->height; y++)
        png_read_row(png, rgba + 4 * (size_t)y * (size_t)file->width, NULL);
    png_read_end(png, info); /* a transparent colour may stand there */
}

/* rgba NULL: the head alone. */
static bool read_file(png_structp png, png_infop info, PlainPng *file, unsigned char *rgba) {
    Source source = {file->bytes, file->size};
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_read_fn(png, &source, take);
    png_read_info(png, info);
    if (!read_head(png, info, file)) return false;
    if (rgba) read_rows(png, info, file, rgba);
    return !png_get_valid(png, info, PNG_INFO_tRNS | PNG_INFO_sBIT);
}

static bool read(PlainPng *file, unsigned char *rgba) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, give_up, give_up);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    bool ok = info && read_file(png, info, file, rgba);
    png_destroy_read_struct(&png, &info, NULL);
    return ok;
}

bool plain_png_open(const unsigned char *bytes, size_t size, PlainPng *out) {
    *out = (PlainPng){.bytes = bytes, .size = size};
    return read(out, NULL);
}

bool plain_png_read(const PlainPng *png, unsigned char *rgba) {
    PlainPng file = *png;
    return read(&file, rgba);
}

/* ---- files of any kind ------------------------------------------------------------------- */

static void keep_words(png_structp png, png_const_charp words) {
    char *why = png_get_error_ptr(png);
    snprintf(why, PNG_WHY_BYTES, "%s", words);
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp words) {
    (void)png;
    (void)words;
}

/* Every row into the same one, freed by the caller: a fault jumps out of here. */
static bool decode_all(png_structp png, png_infop info, Source *source, double most_pixels,
                       unsigned char **row) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, source, take);
    png_read_info(png, info);
    uint32_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    if ((double)width * height > most_pixels) return true;
    int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    *row = malloc(png_get_rowbytes(png, info));
    for (int pass = 0; *row && pass < passes; pass++)
        for (uint32_t y = 0; y < height; y++) png_read_row(png, *row, NULL);
    if (*row) png_read_end(png, info);
    return true;
}

bool png_is_sound(const unsigned char *bytes, size_t size, double most_pixels,
                  char why[static PNG_WHY_BYTES]) {
    Source source = {bytes, size};
    unsigned char *row = NULL;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, why, keep_words, ignore);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    bool ok = !info || decode_all(png, info, &source, most_pixels, &row);
    png_destroy_read_struct(&png, &info, NULL);
    free(row);
    return ok;
}
