/* SPDX-License-Identifier: Apache-2.0 */
/* Textures: decoding, mixing, wrapping. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "image/texture.h"

static double srgb_decoded(double c) {
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static Texture texture_of(const void *pixels, ImageFormat format, int width, int height,
                          TextureWrap wrap) {
    return (Texture){{width, height, format, pixels}, wrap, wrap, false};
}

TEST(colours_are_decoded_from_srgb) {
    float rgba[4];
    for (int code = 0; code < 256; code++) {
        uint8_t p8[4] = {(uint8_t)code, (uint8_t)code, (uint8_t)code, (uint8_t)code};
        Texture t = texture_of(p8, IMAGE_RGBA8, 1, 1, WRAP_REPEAT);
        texture_colour(&t, 0.3f, 0.9f, rgba);
        assert_near(rgba[1], srgb_decoded(code / 255.0), 1e-7);
        assert_near(rgba[3], code / 255.0, 1e-7);
        texture_data(&t, 0.3f, 0.9f, rgba);
        assert_near(rgba[1], code / 255.0, 1e-7);
        uint16_t wide = (uint16_t)(code * 257), p16[4] = {wide, wide, wide, wide};
        t = texture_of(p16, IMAGE_RGBA16, 1, 1, WRAP_REPEAT);
        texture_colour(&t, 0.3f, 0.9f, rgba);
        assert_near(rgba[0], srgb_decoded(code / 255.0), 1e-6);
    }
}

TEST(codes_come_back_exactly) {
    float rgb[3];
    for (int code = 0; code < 256; code++) {
        uint8_t p8[4] = {(uint8_t)code, 0, 255, 255};
        uint16_t p16[4] = {(uint16_t)(code * 257), 0, 65535, 65535};
        Texture t = texture_of(p8, IMAGE_RGBA8, 1, 1, WRAP_CLAMP);
        texture_codes(&t, 0.5f, 0.5f, rgb);
        assert_true(rgb[0] == (float)code && rgb[1] == 0 && rgb[2] == 255);
        t = texture_of(p16, IMAGE_RGBA16, 1, 1, WRAP_CLAMP);
        texture_codes(&t, 0.5f, 0.5f, rgb);
        assert_true(rgb[0] == (float)code && rgb[2] == 255);
    }
    float p32[4] = {0.5f, NAN, 7, 1};
    Texture t = texture_of(p32, IMAGE_RGBA32F, 1, 1, WRAP_CLAMP);
    texture_codes(&t, 0.5f, 0.5f, rgb);
    assert_true(rgb[0] == 127.5f && rgb[1] == 0 && rgb[2] == 255);
}

/* A row of four texels 0, 10, 20, 40 (times 1 in every channel). */
static float row_at(TextureWrap wrap, bool nearest, float u) {
    static const float ROW[16] = {0, 0, 0, 0, 10, 10, 10, 10, 20, 20, 20, 20, 40, 40, 40, 40};
    Texture t = texture_of(ROW, IMAGE_RGBA32F, 4, 1, wrap);
    float rgba[4];
    t.nearest = nearest;
    texture_data(&t, u, 0.5f, rgba);
    return rgba[0];
}

TEST(between_texels_the_value_is_linear) {
    for (int wrap = WRAP_REPEAT; wrap <= WRAP_MIRROR; wrap++) {
        assert_near(row_at((TextureWrap)wrap, false, 0.125f), 0, 1e-5); /* a texel's centre */
        assert_near(row_at((TextureWrap)wrap, false, 0.375f), 10, 1e-5);
        assert_near(row_at((TextureWrap)wrap, false, 0.25f), 5, 1e-5);
        assert_near(row_at((TextureWrap)wrap, false, 0.8125f), 35, 1e-4);
    }
    float grid[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 5, 5, 5, 5}, rgba[4];
    Texture t = texture_of(grid, IMAGE_RGBA32F, 2, 2, WRAP_CLAMP);
    for (int i = 0; i <= 10; i++) {
        for (int j = 0; j <= 10; j++) {
            double x = i / 10.0, y = j / 10.0;
            texture_data(&t, (float)(0.25 + x / 2), (float)(0.25 + y / 2), rgba);
            assert_near(rgba[2], x * (1 - y) + 2 * (1 - x) * y + 5 * x * y, 1e-5);
        }
    }
}

TEST(over_the_edge_the_wrap_mode_decides) {
    assert_near(row_at(WRAP_REPEAT, false, 0), 20, 1e-4); /* half of 40 and half of 0 */
    assert_near(row_at(WRAP_CLAMP, false, 0), 0, 1e-5);
    assert_near(row_at(WRAP_MIRROR, false, 0), 0, 1e-5);
    assert_near(row_at(WRAP_REPEAT, false, 5.375f), 10, 1e-4);
    assert_near(row_at(WRAP_REPEAT, false, -0.625f), 10, 1e-4);
    assert_near(row_at(WRAP_CLAMP, false, 5.375f), 40, 1e-4);
    assert_near(row_at(WRAP_CLAMP, false, -3), 0, 1e-5);
    assert_near(row_at(WRAP_MIRROR, false, 1.375f), 20, 1e-4); /* falls on 0.625 */
    assert_near(row_at(WRAP_MIRROR, false, -0.375f), 10, 1e-4);
    assert_near(row_at(WRAP_MIRROR, false, 2.375f), 10, 1e-4);
    assert_true(row_at(WRAP_REPEAT, true, 0.26f) == 10 && row_at(WRAP_REPEAT, true, 1) == 0);
    float below = row_at(WRAP_REPEAT, true, -1e-9f); /* rounds to the edge itself */
    assert_true(below == 0 || below == 40);
    assert_true(row_at(WRAP_CLAMP, true, 1) == 40 && row_at(WRAP_MIRROR, true, 1) == 40);
}

TEST(no_coordinate_leaves_the_texture) {
    static const float WILD[] = {NAN,      INFINITY,      -INFINITY,   1e38f,
                                 -1e38f,   1e-45f,        -1e-45f,     4194304,
                                 -4194304, 2147483648.0f, 0.99999994f, -5.9e-8f};
    uint8_t *pixels = malloc(3 * 5 * 4);
    memset(pixels, 77, 3 * 5 * 4);
    for (int wrap = WRAP_REPEAT; wrap <= WRAP_MIRROR; wrap++) {
        for (int i = 0; i < 12 * 12 * 2; i++) {
            Texture t = texture_of(pixels, IMAGE_RGBA8, 3, 5, (TextureWrap)wrap);
            float rgba[4], rgb[3];
            t.nearest = i & 1;
            texture_data(&t, WILD[i / 2 % 12], WILD[i / 24], rgba);
            assert_near(rgba[0], 77 / 255.0, 1e-6);
            texture_codes(&t, WILD[i / 2 % 12], WILD[i / 24], rgb);
            assert_true(rgb[0] == 77);
        }
    }
    free(pixels);
}

TEST_PROGRAM(NULL, NULL)
