/* SPDX-License-Identifier: Apache-2.0 */
/* Plain JPEG pictures: the library's pixels to the bit, or left to the library. */
#include "fixture.h"

#include <jpeglib.h>

#include "base/sampler.h"
#include "image/plain/plain_jpeg.h"
#include "openimageio/image_file.h"

enum { SIDE_MAX = 70, BYTES_MAX = 1 << 16 };

/* What a file is required to be. */
typedef struct Wish {
    int width, height, components, quality;
    int across, down; /* samples of the first component for one of the others; 0: 1 */
    int restart;      /* rows of blocks between marks */
    bool is_progressive;
} Wish;

typedef struct Bytes {
    unsigned char *data;
    unsigned long size;
} Bytes;

static void set(struct jpeg_compress_struct *jpeg, const Wish *wish) {
    static const J_COLOR_SPACE spaces[] = {0, JCS_GRAYSCALE, 0, JCS_RGB, JCS_CMYK};
    jpeg->image_width = (JDIMENSION)wish->width;
    jpeg->image_height = (JDIMENSION)wish->height;
    jpeg->input_components = wish->components;
    jpeg->in_color_space = spaces[wish->components];
    jpeg_set_defaults(jpeg);
    jpeg_set_quality(jpeg, wish->quality, TRUE);
    jpeg->restart_in_rows = wish->restart;
    if (wish->across) jpeg->comp_info[0].h_samp_factor = wish->across;
    if (wish->down) jpeg->comp_info[0].v_samp_factor = wish->down;
    if (wish->is_progressive) jpeg_simple_progression(jpeg);
}

/* Any bytes are a picture. To be freed. */
static Bytes make_jpeg(const Wish *wish) {
    static unsigned char rows[4 * SIDE_MAX];
    struct jpeg_error_mgr errors;
    struct jpeg_compress_struct jpeg = {.err = jpeg_std_error(&errors)};
    Bytes out = {0};
    uint32_t dice = 0;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &out.data, &out.size);
    set(&jpeg, wish);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < wish->height; y++) {
        JSAMPROW row = rows;
        for (int i = 0; i < wish->width * wish->components; i++)
            rows[i] = (unsigned char)(hash_u32(dice++) >> 24);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    return out;
}

static bool read_plain(Bytes jpeg, PlainJpeg *head, unsigned char *rgba) {
    return plain_jpeg_open(jpeg.data, jpeg.size, head) && plain_jpeg_read(head, rgba);
}

/* Both readers' pixels, compared: grey is all three colours, and everything is opaque. */
static void assert_as_the_library(Wish wish) {
    static unsigned char rgba[4 * BYTES_MAX], pixels[BYTES_MAX];
    PlainJpeg head;
    ImageDecoder *decoder;
    Bytes jpeg = make_jpeg(&wish);
    assert_true(read_plain(jpeg, &head, rgba));
    assert_done(image_decoder_create("jpeg", "test", jpeg.data, jpeg.size, &decoder, &err));
    ImageFileInfo info = image_decoder_info(decoder);
    assert_int_equal(info.width, head.width);
    assert_int_equal(info.height, head.height);
    assert_int_equal(info.channels, wish.components);
    assert_done(image_decoder_read(decoder, pixels, &err));
    for (int i = 0; i < head.width * head.height; i++) {
        for (int c = 0; c < 3; c++)
            assert_int_equal(rgba[4 * i + c], pixels[i * info.channels + c % info.channels]);
        assert_int_equal(rgba[4 * i + 3], 255);
    }
    image_decoder_destroy(decoder);
    free(jpeg.data);
}

TEST(pixels_are_the_librarys_for_every_size_and_kind) {
    for (int side = 1; side <= SIDE_MAX; side += 23)
        for (int way = 0; way < 16; way++) {
            Wish wish = {side,
                         SIDE_MAX + 1 - side,
                         3,
                         way & 1 ? 95 : 30,
                         .across = 1 + way / 8,
                         .down = 1 + way / 4 % 2,
                         .is_progressive = way & 2};
            assert_as_the_library(wish);
        }
    assert_as_the_library((Wish){50, 60, 1, 80, .restart = 0});
    assert_as_the_library((Wish){50, 60, 1, 80, .is_progressive = true});
    assert_as_the_library((Wish){50, 60, 3, 80, .restart = 2});
}

TEST(what_has_four_components_is_left_to_the_library) {
    PlainJpeg head;
    Wish wish = {9, 9, 4, .quality = 90};
    Bytes jpeg = make_jpeg(&wish);
    assert_false(plain_jpeg_open(jpeg.data, jpeg.size, &head));
    free(jpeg.data);
}

TEST(a_file_that_is_cut_anywhere_or_marked_wrongly_is_left) {
    static unsigned char rgba[4 * BYTES_MAX];
    PlainJpeg head;
    Wish wish = {20, 30, 3, .quality = 60};
    Bytes jpeg = make_jpeg(&wish);
    assert_true(read_plain(jpeg, &head, rgba));
    for (Bytes cut = jpeg; cut.size > 0;) {
        cut.size--;
        assert_false(read_plain(cut, &head, rgba));
    }
    jpeg.data[1] = 0xd9;
    assert_false(read_plain(jpeg, &head, rgba));
    free(jpeg.data);
}

TEST_PROGRAM(NULL, NULL)
