/* SPDX-License-Identifier: Apache-2.0 */
/* A PNG that is written is read back, by us and by the library. */
#include "fixture.h"

#include "base/sampler.h"
#include "image/plain/picture_png.h"
#include "image/plain/plain_png.h"
#include "openimageio/image_file.h"

enum { WIDTH = 23, HEIGHT = 19, COUNT = WIDTH * HEIGHT * 3 };

static const uint16_t *random_codes(void) {
    static uint16_t codes[COUNT];
    for (int i = 0; i < COUNT; i++) codes[i] = (uint16_t)(hash_u32((uint32_t)i) >> 16);
    return codes;
}

static FileBytes encode(PixelType type, const void *codes, Arena *arena) {
    const ImageToEncode image = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .channels = 3,
                                 .type = type,
                                 .pixels = codes,
                                 .is_srgb = true,
                                 .description = "a room"};
    FileBytes out;
    assert_done(picture_png_encode(&image, arena, &out, &err));
    assert_int_equal(out.data[out.size], 0);
    return out;
}

ARENA_TEST(codes_of_8_bits_come_back) {
    const unsigned char *codes = (const unsigned char *)random_codes();
    unsigned char rgba[WIDTH * HEIGHT * 4];
    PlainPng head;
    FileBytes png = encode(PIXEL_U8, codes, &arena);
    assert_true(plain_png_open(png.data, png.size, &head) && plain_png_read(&head, rgba));
    assert_int_equal(head.width, WIDTH);
    assert_int_equal(head.height, HEIGHT);
    for (int i = 0; i < COUNT; i++) assert_int_equal(rgba[i / 3 * 4 + i % 3], codes[i]);
}

ARENA_TEST(codes_of_16_bits_come_back) {
    const uint16_t *codes = random_codes();
    uint16_t read[COUNT];
    ImageDecoder *decoder;
    FileBytes png = encode(PIXEL_U16, codes, &arena);
    assert_done(image_decoder_create("png", "test", png.data, png.size, &decoder, &err));
    assert_int_equal(image_decoder_info(decoder).type, PIXEL_U16);
    assert_done(image_decoder_read(decoder, read, &err));
    image_decoder_destroy(decoder);
    assert_memory_equal(read, codes, sizeof read);
}

/* Viewers and Parhelion's own reader go by them. */
ARENA_TEST(a_file_says_what_its_codes_mean) {
    static const char *const parts[] = {"gAMA", "sRGB", "cHRM", "Software", "a room"};
    FileBytes png = encode(PIXEL_U8, random_codes(), &arena);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        assert_non_null(memmem(png.data, png.size, parts[i], strlen(parts[i])));
}

TEST(what_libpng_refuses_is_an_error) {
    Arena arena = arena_reserve((size_t)1 << 20);
    const ImageToEncode none = {.width = 0, .height = 1, .channels = 3, .type = PIXEL_U8};
    FileBytes out;
    assert_fails_as(picture_png_encode(&none, &arena, &out, &err), ERROR_LIBRARY,
                    "encoding a png picture");
    arena_release(&arena);
}

TEST_PROGRAM(make_arena, drop_arena)
