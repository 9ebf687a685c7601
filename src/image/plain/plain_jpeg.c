/* SPDX-License-Identifier: Apache-2.0 */
#include "image/plain/plain_jpeg.h"

#include <setjmp.h>
#include <stdio.h>

#include <jpeglib.h>

/* libjpeg's, first, so that it is found from there. */
typedef struct PlainReader {
    struct jpeg_error_mgr errors;
    jmp_buf back;
} PlainReader;

static void give_up(j_common_ptr jpeg) {
    longjmp(((PlainReader *)jpeg->err)->back, 1);
}

/* A warning too (level -1): its faults are the other library's to report. */
static void give_up_at_warnings(j_common_ptr jpeg, int level) {
    if (level < 0) give_up(jpeg);
}

static bool read_head(struct jpeg_decompress_struct *jpeg, PlainJpeg *out) {
    jpeg_mem_src(jpeg, out->bytes, out->size);
    if (jpeg_read_header(jpeg, TRUE) != JPEG_HEADER_OK || jpeg->data_precision != 8 ||
        (jpeg->num_components != 1 && jpeg->num_components != 3))
        return false;
    out->width = (int)jpeg->image_width;
    out->height = (int)jpeg->image_height;
    return true;
}

/* A row's bytes are spread where they lie, from its end. */
static void spread(unsigned char *row, int width, int components) {
    for (int x = width - 1; x >= 0; x--) {
        unsigned char value[3];
        for (int c = 0; c < 3; c++) value[c] = row[x * components + (components == 3 ? c : 0)];
        for (int c = 0; c < 3; c++) row[4 * x + c] = value[c];
        row[4 * x + 3] = 255;
    }
}

static void read_rows(struct jpeg_decompress_struct *jpeg, unsigned char *rgba) {
    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        unsigned char *row = rgba + 4 * (size_t)jpeg->output_scanline * jpeg->output_width;
        jpeg_read_scanlines(jpeg, &row, 1);
        spread(row, (int)jpeg->output_width, jpeg->output_components);
    }
    jpeg_finish_decompress(jpeg);
}

/* rgba NULL: the head alone. */
static bool read_file(struct jpeg_decompress_struct *jpeg, PlainJpeg *file, unsigned char *rgba) {
    PlainReader reader;
    jpeg->err = jpeg_std_error(&reader.errors);
    reader.errors.error_exit = give_up;
    reader.errors.emit_message = give_up_at_warnings;
    if (setjmp(reader.back)) return false;
    jpeg_create_decompress(jpeg);
    if (!read_head(jpeg, file)) return false;
    if (rgba) read_rows(jpeg, rgba);
    return true;
}

static bool read(PlainJpeg *file, unsigned char *rgba) {
    struct jpeg_decompress_struct jpeg = {0};
    bool ok = read_file(&jpeg, file, rgba);
    jpeg_destroy_decompress(&jpeg);
    return ok;
}

bool plain_jpeg_open(const unsigned char *bytes, size_t size, PlainJpeg *out) {
    *out = (PlainJpeg){.bytes = bytes, .size = size};
    return read(out, NULL);
}

bool plain_jpeg_read(const PlainJpeg *jpeg, unsigned char *rgba) {
    PlainJpeg file = *jpeg;
    return read(&file, rgba);
}
