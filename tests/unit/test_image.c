/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures: what is decoded is what the file says; broken files are refused. */
#include "fixture.h"

#include "image/frame.h"
#include "image/image.h"
#include "openimageio/image_file.h"

/* ---- PNG files made by hand, so that every kind of them can be had ----------------------- */

typedef struct Bytes {
    unsigned char data[1 << 16];
    size_t size;
} Bytes;

static void put(Bytes *b, const void *data, size_t size) {
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

static void put_u32(Bytes *b, uint32_t v) {
    unsigned char bytes[4] = {(unsigned char)(v >> 24), (unsigned char)(v >> 16),
                              (unsigned char)(v >> 8), (unsigned char)v};
    put(b, bytes, 4);
}

static uint32_t crc_of(const unsigned char *data, size_t size) {
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

static void put_chunk(Bytes *b, const char *type, const void *data, size_t size) {
    put_u32(b, (uint32_t)size);
    size_t start = b->size;
    put(b, type, 4);
    put(b, data, size);
    put_u32(b, crc_of(b->data + start, b->size - start));
}

/* zlib (RFC 1950) with one stored block. */
static void put_pixels(Bytes *b, const unsigned char *rows, size_t size) {
    static Bytes z;
    uint32_t low = 1, high = 0;
    unsigned char head[7] = {0x78,
                             1,
                             1,
                             (unsigned char)size,
                             (unsigned char)(size >> 8),
                             (unsigned char)~size,
                             (unsigned char)(~size >> 8)};
    z.size = 0;
    put(&z, head, 7);
    put(&z, rows, size);
    for (size_t i = 0; i < size; i++) {
        low = (low + rows[i]) % 65521;
        high = (high + low) % 65521;
    }
    put_u32(&z, high << 16 | low);
    put_chunk(b, "IDAT", z.data, z.size);
}

typedef struct PngKind {
    uint32_t width, height;
    unsigned char bits, colour; /* 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA */
    const unsigned char *palette;
    size_t palette_size;
} PngKind;

/* rows: each with its filter byte 0 in front. */
static const Bytes *make_png(PngKind kind, const unsigned char *rows, size_t size) {
    static Bytes png;
    Bytes head = {.size = 0};
    png.size = 0;
    put(&png, "\x89PNG\r\n\x1a\n", 8);
    put_u32(&head, kind.width);
    put_u32(&head, kind.height);
    put(&head, (unsigned char[]){kind.bits, kind.colour, 0, 0, 0}, 5);
    put_chunk(&png, "IHDR", head.data, head.size);
    if (kind.palette) put_chunk(&png, "PLTE", kind.palette, kind.palette_size);
    put_pixels(&png, rows, size);
    put_chunk(&png, "IEND", "", 0);
    return &png;
}

static Image read_png(const Bytes *png, Arena *arena) {
    Image image;
    assert_done(image_read_memory(png->data, png->size, "test.png", arena, &image, &err));
    return image;
}

static void assert_pixel8(const Image *image, int at, int r, int g, int b, int a) {
    const uint8_t *p = (const uint8_t *)image->pixels + 4 * at;
    assert_int_equal(image->format, IMAGE_RGBA8);
    int want[4] = {r, g, b, a};
    for (int c = 0; c < 4; c++) assert_int_equal(p[c], want[c]);
}

ARENA_TEST(every_kind_of_png_becomes_rgba) {
    const unsigned char grey[] = {0, 7, 200}, bits[] = {0, 0xa0};
    Image i = read_png(make_png((PngKind){2, 1, 8, 0, NULL, 0}, grey, 3), &arena);
    assert_pixel8(&i, 1, 200, 200, 200, 255);
    i = read_png(make_png((PngKind){1, 1, 8, 4, NULL, 0}, (unsigned char[]){0, 90, 40}, 3), &arena);
    assert_pixel8(&i, 0, 90, 90, 90, 40);
    i = read_png(make_png((PngKind){1, 1, 8, 2, NULL, 0}, (unsigned char[]){0, 1, 2, 3}, 4),
                 &arena);
    assert_pixel8(&i, 0, 1, 2, 3, 255);
    i = read_png(make_png((PngKind){2, 1, 8, 3, (unsigned char[]){9, 8, 7, 60, 50, 40}, 6},
                          (unsigned char[]){0, 1, 0}, 3),
                 &arena);
    assert_pixel8(&i, 0, 60, 50, 40, 255);
    assert_pixel8(&i, 1, 9, 8, 7, 255);
    i = read_png(make_png((PngKind){8, 1, 1, 0, NULL, 0}, bits, 2), &arena);
    assert_pixel8(&i, 0, 255, 255, 255, 255);
    assert_pixel8(&i, 1, 0, 0, 0, 255);
}

/* A kilobyte of header may not take a gigabyte. */
ARENA_TEST(user_data_larger_than_a_dpx_is_refused) {
    Image image;
    unsigned char little[64] = "XPDS", big[64] = "SDPX";
    little[35] = big[32] = 0x58;
    assert_fails(image_read_memory(little, 64, "a.dpx", &arena, &image, &err),
                 "1476395008 bytes of user data are stated, the file has 64");
    assert_fails(image_read_memory(big, 64, "a.dpx", &arena, &image, &err),
                 "1476395008 bytes of user data are stated, the file has 64");
    assert_fails(image_read_memory(big, 35, "a.dpx", &arena, &image, &err),
                 "damaged dpx picture: cut off in its header");
}

ARENA_TEST(alpha_stays_straight) {
    unsigned char row[] = {0, 200, 100, 50, 128, 200, 100, 50, 0};
    Image i = read_png(make_png((PngKind){2, 1, 8, 6, NULL, 0}, row, 9), &arena);
    assert_pixel8(&i, 0, 200, 100, 50, 128);
    assert_pixel8(&i, 1, 200, 100, 50, 0);
}

ARENA_TEST(sixteen_bits_stay_sixteen_bits) {
    unsigned char row[] = {0, 0x12, 0x34, 0xff, 0xfe, 0, 1};
    Image i = read_png(make_png((PngKind){1, 1, 16, 2, NULL, 0}, row, 7), &arena);
    const uint16_t *p = i.pixels;
    assert_int_equal(i.format, IMAGE_RGBA16);
    assert_int_equal(p[0], 0x1234);
    assert_int_equal(p[1], 0xfffe);
    assert_int_equal(p[2], 1);
    assert_int_equal(p[3], 65535);
}

/* ---- what must be refused ------------------------------------------------------------ */

ARENA_TEST(a_frame_without_colours_is_no_picture) {
    FrameImage frame = frame_create(2, 2, (ExrWindow){0, 0, 2, 2}, 1, 0, &arena);
    char path[] = "depth-XXXXXX";
    Image image;
    close(mkstemp(path));
    frame_add_channel(&frame, "depth.Z", false, &arena);
    assert_done(frame_write(path, &frame, &err));
    assert_fails(image_read(path, &arena, &image, &err), "no channel R; R, G, B or Y are required");
    unlink(path);
}

ARENA_TEST(refuses_a_bomb_before_decoding_it) {
    Arena before = arena;
    Image image = {.width = -7};
    Error err = {0};
    const PngKind bomb = {40000, 40000, 8, 0, NULL, 0};
    const Bytes *png = make_png(bomb, (unsigned char[]){0}, 1);
    assert_false(image_read_memory(png->data, png->size, "bomb.png", &arena, &image, &err));
    assert_error_has(&err, "40000 x 40000 pixels");
    assert_error_has(&err, "at most");
    assert_string_equal(err.file, "bomb.png");
    assert_int_equal(image.width, -7);
    assert_ptr_equal(arena.next, before.next);
}

TEST(says_when_memory_is_too_small) {
    Arena arena = arena_reserve(1 << 20);
    Image image;
    const Bytes *png = make_png((PngKind){2000, 2000, 8, 6, NULL, 0}, (unsigned char[]){0}, 1);
    assert_fails_as(image_read_memory(png->data, png->size, "big.png", &arena, &image, &err),
                    ERROR_MEMORY, "MB are left");
    arena_release(&arena);
}

ARENA_TEST(refuses_every_prefix_of_a_png) {
    Arena before = arena;
    unsigned char row[] = {0, 200, 100, 50, 128, 9, 9, 9, 0};
    Bytes png = *make_png((PngKind){2, 1, 8, 6, NULL, 0}, row, 9);
    for (size_t size = 0; size < png.size; size++) {
        Image image;
        Error err = {0};
        unsigned char *exact = malloc(size + (size == 0)); /* so that ASan sees a step beyond */
        memcpy(exact, png.data, size);
        if (image_read_memory(exact, size, "cut.png", &arena, &image, &err))
            fail_msg("%zu of %zu bytes were accepted", size, png.size);
        assert_true(err.text[0] && !strchr(err.text, '\n'));
        assert_string_equal(err.file, "cut.png");
        assert_ptr_equal(arena.next, before.next);
        free(exact);
    }
}

/* Every prefix of what this program writes, and of a Radiance picture. */
ARENA_TEST(refuses_every_prefix_of_other_formats) {
    static const char HDR[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n12341234";
    static const char *const FORMATS[] = {"jpeg", "tiff", "hdr"};
    Arena scratch;
    uint8_t codes[8 * 8 * 3];
    for (size_t i = 0; i < sizeof codes; i++) codes[i] = (uint8_t)(i * 37);
    for (int f = 0; f < 3; f++) {
        ImageToEncode in = {.width = 8,
                            .height = 8,
                            .channels = 3,
                            .type = PIXEL_U8,
                            .pixels = codes,
                            .jpeg_quality = f == 0 ? 90 : 0};
        EncodedImage *encoded = NULL;
        Error err = {0};
        Image image;
        size_t whole = sizeof HDR - 1;
        if (f < 2) assert_true(image_encode(FORMATS[f], &in, &encoded, &err));
        const void *bytes = f < 2 ? encoded_image_bytes(encoded, &whole) : HDR;
        for (size_t size = 0; size <= whole; size++) {
            unsigned char *exact = malloc(size + (size == 0));
            memcpy(exact, bytes, size);
            scratch = arena;
            bool read = image_read_memory(exact, size, "cut", &scratch, &image, &err);
            if (read != (size == whole))
                fail_msg("%s: %zu of %zu bytes: %s", FORMATS[f], size, whole, err.text);
            free(exact);
        }
        encoded_image_destroy(encoded);
    }
}

static void put_reversed(Bytes *b, uint64_t value, unsigned width, bool is_big_endian) {
    for (unsigned i = 0; i < width; i++) {
        unsigned shift = 8 * (is_big_endian ? width - 1 - i : i);
        unsigned char byte = (unsigned char)(value >> shift);
        put(b, &byte, 1);
    }
}

/* 2 x 2 pixels of 16-bit grey, not packed, the directory in front of them; wide: BigTIFF. */
static const Bytes *make_tiff(bool is_big_endian, bool is_wide) {
    static Bytes out;
    static const unsigned entries[][3] = {{256, 3, 2}, {257, 3, 2}, {258, 3, 16},
                                          {259, 3, 1}, {262, 3, 1}, {273, 4, 0},
                                          {277, 3, 1}, {278, 3, 2}, {279, 4, 8}};
    unsigned count = sizeof entries / sizeof *entries, wide = is_wide ? 8 : 4;
    unsigned head = is_wide ? 16 : 8, before = is_wide ? 8 : 2;
    unsigned pixels = head + before + count * (4 + 2 * wide) + wide;
    out.size = 0;
    put(&out, is_big_endian ? "MM" : "II", 2);
    put_reversed(&out, is_wide ? 43 : 42, 2, is_big_endian);
    if (is_wide) put_reversed(&out, 8, 2, is_big_endian);
    if (is_wide) put_reversed(&out, 0, 2, is_big_endian);
    put_reversed(&out, head, wide, is_big_endian);
    put_reversed(&out, count, before, is_big_endian);
    for (unsigned i = 0; i < count; i++) {
        unsigned width = entries[i][1] == 3 ? 2 : 4;
        put_reversed(&out, entries[i][0], 2, is_big_endian);
        put_reversed(&out, entries[i][1], 2, is_big_endian);
        put_reversed(&out, 1, wide, is_big_endian);
        put_reversed(&out, entries[i][0] == 273 ? pixels : entries[i][2], width, is_big_endian);
        put_reversed(&out, 0, wide - width, is_big_endian);
    }
    put_reversed(&out, 0, wide, is_big_endian);
    for (unsigned i = 0; i < 4; i++) put_reversed(&out, 1000 * (i + 1), 2, is_big_endian);
    return &out;
}

ARENA_TEST(refuses_every_prefix_of_a_tiff_whose_pixels_are_last) {
    for (int kind = 0; kind < 4; kind++) {
        const Bytes *tiff = make_tiff(kind & 1, kind & 2);
        Image image;
        Error err = {0};
        assert_true(image_read_memory(tiff->data, tiff->size, "a.tif", &arena, &image, &err));
        assert_int_equal(((const uint16_t *)image.pixels)[4 * 3 + 1], 4000);
        for (size_t size = 0; size < tiff->size; size++)
            assert_false(image_read_memory(tiff->data, size, "a.tif", &arena, &image, &err));
        assert_error_has(&err, "damaged tiff picture: cut off, pixels are missing");
    }
}

ARENA_TEST(names_what_cannot_be_read) {
    Image image;
    Error err = {0};
    assert_false(image_read_memory("hello, world", 12, "a.txt", &arena, &image, &err));
    assert_error_has(&err, "not a picture that can be read");
    assert_false(image_read("no/such/file.png", &arena, &image, &err));
    assert_string_equal(err.file, "no/such/file.png");
    assert_error_has(&err, "No such file");
    assert_int_equal(err.code, ERROR_INPUT);
    assert_false(image_read("/", &arena, &image, &err));
    assert_error_has(&err, "folder");
}

/* ---- other formats ----------------------------------------------------------------------- */

ARENA_TEST(reads_radiance_pictures) {
    static const char HDR[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                              "\x80\x40\x20\x81\x80\x80\x80\x8b";
    Image image;
    assert_done(image_read_memory(HDR, sizeof HDR - 1, "a.hdr", &arena, &image, &err));
    const float *p = image.pixels;
    assert_int_equal(image.format, IMAGE_RGBA32F);
    /* (0x80 + 1/2) / 256 * 2^(0x81 - 128): the middle of a code's step */
    assert_close(p[0], 128.5 / 128, 1e-6);
    assert_close(p[1], 64.5 / 128, 1e-6);
    assert_close(p[2], 32.5 / 128, 1e-6);
    assert_close(p[4], 1028, 1e-6);
    assert_true(p[3] == 1 && p[7] == 1);
}

ARENA_TEST(what_is_encoded_reads_back) {
    static const char *const FORMATS[] = {"png", "tiff"};
    for (int k = 0; k < 4; k++) {
        uint16_t codes[12];
        for (int i = 0; i < 12; i++) codes[i] = (uint16_t)(i * 5461);
        bool wide = k & 1;
        ImageToEncode in = {.width = 2,
                            .height = 2,
                            .channels = 3,
                            .type = wide ? PIXEL_U16 : PIXEL_U8,
                            .pixels = codes,
                            .is_srgb = true,
                            .description = "a picture"};
        EncodedImage *encoded;
        Image image;
        size_t size;
        assert_done(image_encode(FORMATS[k / 2], &in, &encoded, &err));
        const void *bytes = encoded_image_bytes(encoded, &size);
        assert_done(image_read_memory(bytes, size, "x", &arena, &image, &err));
        for (int i = 0; i < 12; i++) {
            int at = i / 3 * 4 + i % 3;
            if (wide) assert_int_equal(((const uint16_t *)image.pixels)[at], codes[i]);
            else assert_int_equal(((const uint8_t *)image.pixels)[at], ((uint8_t *)codes)[i]);
        }
        encoded_image_destroy(encoded);
    }
}

TEST(the_same_picture_makes_the_same_bytes) {
    static const char *const FORMATS[] = {"png", "jpeg", "tiff"};
    uint8_t codes[300];
    for (int i = 0; i < 300; i++) codes[i] = (uint8_t)(i * 37);
    ImageToEncode in = {.width = 10,
                        .height = 10,
                        .channels = 3,
                        .type = PIXEL_U8,
                        .pixels = codes,
                        .jpeg_quality = 95,
                        .description = "made so"};
    EncodedImage *encoded[2][3];
    for (int run = 0; run < 2; run++) {
        in.jpeg_quality = 0;
        for (int f = 0; f < 3; f++) {
            in.jpeg_quality = f == 1 ? 95 : 0;
            assert_done(image_encode(FORMATS[f], &in, &encoded[run][f], &err));
        }
        if (run == 0) usleep(1100000); /* a time of day in the file would differ now */
    }
    for (int f = 0; f < 3; f++) {
        size_t a, b;
        const void *first = encoded_image_bytes(encoded[0][f], &a);
        const void *second = encoded_image_bytes(encoded[1][f], &b);
        assert_int_equal(a, b);
        assert_memory_equal(first, second, a);
        encoded_image_destroy(encoded[0][f]);
        encoded_image_destroy(encoded[1][f]);
    }
    assert_fails(image_encode("nonsense", &in, &encoded[0][0], &err), "nonsense");
}

/* Whatever comes of it: no crash, and one line of reasons when it is refused. */
ARENA_TEST(survives_flipped_bits) {
    static const char *const FORMATS[] = {"png", "jpeg", "tiff"};
    uint8_t codes[16 * 16 * 3];
    unsigned seed = 3;
    for (size_t i = 0; i < sizeof codes; i++) codes[i] = (uint8_t)(i * i >> 3);
    for (int f = 0; f < 3; f++) {
        ImageToEncode in = {.width = 16,
                            .height = 16,
                            .channels = 3,
                            .type = PIXEL_U8,
                            .pixels = codes,
                            .jpeg_quality = f == 1 ? 90 : 0};
        EncodedImage *encoded;
        Error err = {0};
        size_t size;
        assert_true(image_encode(FORMATS[f], &in, &encoded, &err));
        const void *bytes = encoded_image_bytes(encoded, &size);
        for (int i = 0; i < 400; i++) {
            Arena scratch = arena;
            Image image;
            unsigned char *flipped = malloc(size);
            memcpy(flipped, bytes, size);
            seed = seed * 1664525u + 1013904223u;
            flipped[(seed >> 8) % size] ^= (unsigned char)(1u << (seed & 7));
            err.text[0] = '\0';
            if (!image_read_memory(flipped, size, "flipped", &scratch, &image, &err))
                assert_true(err.text[0] && !strchr(err.text, '\n'));
            free(flipped);
        }
        encoded_image_destroy(encoded);
    }
}

/* ---- environment pictures ------------------------------------------------------------ */

/* Skips the test when the shared data are not there. */
static Image read_shared(const char *name, Arena *arena) {
    char path[512];
    Image image = {0};
    Error err = {0};
    snprintf(path, sizeof path, "%s/%s", SHARED_DATA_DIR, name);
    if (!file_exists(path)) skip();
    if (!image_read(path, arena, &image, &err)) fail_msg("%s: %s", path, err.text);
    return image;
}

ARENA_TEST(negative_values_of_environments_are_kept) {
    Image image = read_shared("hdri/blender/interior.exr", &arena);
    const float *p = image.pixels;
    long negative = 0;
    for (int i = 0; i < image.width * image.height * 4; i++) negative += p[i] < 0;
    assert_int_equal(image.width, 1024);
    assert_int_equal(negative, 8980);
}

ARENA_TEST(the_orientation_picture_can_be_read) {
    Image image = read_shared("hdri/openexr-env/OrientationLatLong.exr", &arena);
    const float *p = image.pixels;
    assert_int_equal(image.width, 1024);
    assert_int_equal(image.height, 512);
    for (int i = 0; i < 1024 * 512 * 4; i++) assert_true(p[i] >= 0 && p[i] <= 1);
}

ARENA_TEST(a_data_window_is_placed_in_the_display_window) {
    Image whole = read_shared("exr/DisplayWindow/t01.exr", &arena);
    Image part = read_shared("exr/DisplayWindow/t05.exr", &arena); /* shows 30,20 .. 370,280 */
    assert_int_equal(part.width, 340);
    assert_int_equal(part.height, 260);
    const float *a = whole.pixels, *b = part.pixels;
    for (int y = 0; y < 260; y++)
        assert_memory_equal(a + ((y + 20) * 400 + 30) * 4, b + y * 340 * 4, 340 * 16);
}

/* The same scene is stored once in Rec.709 and once as XYZ. */
ARENA_TEST(the_primaries_of_a_file_are_honoured) {
    Image a = read_shared("exr/Chromaticities/Rec709.exr", &arena);
    Image b = read_shared("exr/Chromaticities/XYZ.exr", &arena);
    const float *p = a.pixels, *q = b.pixels;
    for (int i = 0; i < a.width * a.height * 4; i++)
        assert_near(q[i], p[i], 0.004 + 0.01 * (double)fabsf(p[i])); /* both are halves */
}

TEST_PROGRAM(make_arena, drop_arena)
