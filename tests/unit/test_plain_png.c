/* SPDX-License-Identifier: Apache-2.0 */
/* Plain PNG pictures: the library's pixels to the bit, or left to the library. */
#include "fixture.h"

#include <zlib.h>

#include "base/sampler.h"
#include "image/plain/plain_png.h"
#include "openimageio/image_file.h"

enum { SIDE_MAX = 40, BYTES_MAX = 1 << 15 };

typedef struct Bytes {
    unsigned char data[BYTES_MAX];
    size_t size;
} Bytes;

/* What a file is required to be; all 0: a plain picture of one part. */
typedef struct Wish {
    int width, height, colour_type, bits, interlaced;
    int filter;          /* of every row; negative: any */
    size_t part_bytes;   /* of the pixels' parts; 0: one */
    const char *extra;   /* a part of two bytes before the pixels */
    int rows_more;       /* than the head says */
    bool wrong_sum, cut; /* of the stream */
} Wish;

static void put_u32(Bytes *b, unsigned long v) {
    for (int shift = 24; shift >= 0; shift -= 8) b->data[b->size++] = (unsigned char)(v >> shift);
}

static void put_part(Bytes *b, const char *type, const unsigned char *data, size_t size) {
    put_u32(b, size);
    size_t start = b->size;
    memcpy(b->data + start, type, 4);
    if (size) memcpy(b->data + start + 4, data, size);
    b->size += 4 + size;
    put_u32(b, crc32(0, b->data + start, (uInt)(4 + size)));
}

static int channels_of(const Wish *wish) {
    return (int[]){1, 0, 3, 1, 2, 0, 4}[wish->colour_type];
}

/* Any bytes are a picture, whatever the filters. */
static size_t random_rows(const Wish *wish, uint32_t *dice, unsigned char *rows) {
    size_t row_bytes = 1 + (size_t)((wish->width * channels_of(wish) * wish->bits + 7) / 8);
    size_t size = row_bytes * (size_t)(wish->height + wish->rows_more);
    for (size_t i = 0; i < size; i++) {
        rows[i] = (unsigned char)(hash_u32((*dice)++) >> 24);
        if (i % row_bytes == 0)
            rows[i] = (unsigned char)(wish->filter < 0 ? rows[i] % 5 : wish->filter);
    }
    return size;
}

static void put_pixels(Bytes *b, const Wish *wish, uint32_t *dice) {
    static unsigned char rows[BYTES_MAX], packed[BYTES_MAX];
    uLongf size = sizeof packed;
    size_t raw = random_rows(wish, dice, rows);
    assert_int_equal(compress(packed, &size, rows, (uLong)raw), Z_OK);
    if (wish->wrong_sum) packed[size - 1] ^= 1;
    if (wish->cut) size -= 6;
    size_t most = wish->part_bytes ? wish->part_bytes : size;
    for (size_t at = 0; at < size; at += most)
        put_part(b, "IDAT", packed + at, size - at < most ? size - at : most);
}

/* Of as many colours as the bits tell apart. */
static void put_palette(Bytes *b, const Wish *wish, uint32_t *dice) {
    unsigned char colours[3 << 8];
    size_t size = (size_t)3 << wish->bits;
    for (size_t i = 0; i < size; i++) colours[i] = (unsigned char)(hash_u32((*dice)++) >> 24);
    put_part(b, "PLTE", colours, size);
}

static const Bytes *make_png(const Wish *wish, uint32_t *dice) {
    static Bytes png;
    Bytes head = {.size = 0};
    memcpy(png.data, "\x89PNG\r\n\x1a\n", 8);
    png.size = 8;
    put_u32(&head, (unsigned long)wish->width);
    put_u32(&head, (unsigned long)wish->height);
    head.data[head.size++] = (unsigned char)wish->bits;
    head.data[head.size++] = (unsigned char)wish->colour_type;
    const unsigned char rest[3] = {0, 0, (unsigned char)wish->interlaced};
    memcpy(head.data + head.size, rest, 3);
    head.size += 3;
    put_part(&png, "IHDR", head.data, head.size);
    if (wish->colour_type == 3) put_palette(&png, wish, dice);
    if (wish->extra) put_part(&png, wish->extra, (const unsigned char *)"\0\5", 2);
    put_pixels(&png, wish, dice);
    put_part(&png, "IEND", NULL, 0);
    return &png;
}

static bool read_plain(const Bytes *png, PlainPng *head, unsigned char *rgba) {
    return plain_png_open(png->data, png->size, head) && plain_png_read(head, rgba);
}

/* Grey is all three colours, what has no alpha is opaque. */
static void assert_rgba_of(const unsigned char *pixel, int channels, const unsigned char *rgba) {
    bool is_grey = channels < 3, has_alpha = channels % 2 == 0;
    for (int c = 0; c < 3; c++) assert_int_equal(rgba[c], pixel[is_grey ? 0 : c]);
    assert_int_equal(rgba[3], has_alpha ? pixel[channels - 1] : 255);
}

/* Both readers' pixels, compared. */
static void assert_as_the_library(const Bytes *png) {
    static unsigned char rgba[4 * BYTES_MAX], pixels[BYTES_MAX];
    PlainPng head;
    ImageDecoder *decoder;
    assert_true(read_plain(png, &head, rgba));
    assert_done(image_decoder_create("png", "test", png->data, png->size, &decoder, &err));
    ImageFileInfo info = image_decoder_info(decoder);
    assert_int_equal(info.width, head.width);
    assert_int_equal(info.height, head.height);
    assert_int_equal(info.alpha_channel, info.channels % 2 ? -1 : info.channels - 1);
    assert_done(image_decoder_read(decoder, pixels, &err));
    for (int i = 0; i < head.width * head.height; i++)
        assert_rgba_of(pixels + i * info.channels, info.channels, rgba + 4 * i);
    image_decoder_destroy(decoder);
}

TEST(pixels_are_the_librarys_for_every_filter_size_and_kind) {
    static const int COLOUR_TYPES[4] = {0, 2, 4, 6};
    uint32_t dice = 0000000;
    for (int kind = 0; kind < 4; kind++)
        for (int filter = -1; filter < 5; filter++)
            for (int side = 1; side <= SIDE_MAX; side += 13) {
                Wish wish = {side, SIDE_MAX + 1 - side, COLOUR_TYPES[kind], 8, .filter = filter};
                assert_as_the_library(make_png(&wish, &dice));
                wish.part_bytes = 7;
                assert_as_the_library(make_png(&wish, &dice));
            }
}

TEST(colours_of_a_palette_are_the_librarys) {
    uint32_t dice = 3000000;
    for (int bits = 1; bits <= 8; bits *= 2)
        for (int side = 1; side <= SIDE_MAX; side += 13) {
            Wish wish = {side, SIDE_MAX + 1 - side, 3, bits, .filter = -1};
            assert_as_the_library(make_png(&wish, &dice));
        }
}

TEST(parts_that_mean_nothing_here_change_nothing) {
    uint32_t dice = 1000000;
    Wish wish = {9, 9, 2, 8, .filter = -1, .extra = "teSt"};
    assert_as_the_library(make_png(&wish, &dice));
}

static void assert_left(Wish wish) {
    static unsigned char rgba[4 * BYTES_MAX];
    PlainPng head;
    uint32_t dice = 2000000;
    assert_false(read_plain(make_png(&wish, &dice), &head, rgba));
}

TEST(what_is_unusual_or_damaged_is_left_to_the_library) {
    assert_left((Wish){9, 9, 2, 16, .filter = 0});
    assert_left((Wish){9, 9, 2, 8, .interlaced = 1});
    assert_left((Wish){9, 9, 2, 8, .extra = "tRNS"});
    assert_left((Wish){9, 9, 2, 8, .extra = "sBIT"});
    assert_left((Wish){9, 9, 2, 8, .extra = "NEWS"});
    assert_left((Wish){9, 9, 2, 8, .filter = 5});
    assert_left((Wish){9, 9, 2, 8, .wrong_sum = true});
    assert_left((Wish){9, 9, 2, 8, .cut = true});
    assert_left((Wish){9, 9, 2, 8, .rows_more = 1});
    assert_left((Wish){9, 9, 2, 8, .rows_more = -1});
    assert_left((Wish){0, 9, 2, 8, .filter = 0});
}

TEST(a_file_that_is_cut_anywhere_is_left) {
    static unsigned char rgba[4 * BYTES_MAX];
    uint32_t dice = 3000000;
    PlainPng head;
    Wish wish = {5, 4, 6, 8, .filter = -1};
    Bytes png = *make_png(&wish, &dice);
    assert_true(read_plain(&png, &head, rgba));
    while (png.size > 0) {
        png.size--;
        assert_false(read_plain(&png, &head, rgba));
    }
}

TEST_PROGRAM(NULL, NULL)
