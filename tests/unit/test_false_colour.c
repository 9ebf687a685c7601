/* SPDX-License-Identifier: Apache-2.0 */
/* False colours, their scale and its letters; colour spaces from primaries. */
#include "fixture.h"

#include "image/colour.h"
#include "image/false_colour.h"
#include "image/icc_profile.h"
#include "image/stroke_font.h"

static double luminance_of_code(const float srgb[3]) {
    double y = 0;
    for (int c = 0; c < 3; c++) {
        double v = (double)srgb[c];
        double linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        y += linear * (c == 0 ? 0.2126 : c == 1 ? 0.7152 : 0.0722);
    }
    return y;
}

TEST(false_colours_grow_lighter_all_the_way) {
    double last = -1;
    for (int i = 0; i <= 200; i++) {
        float rgb[3];
        false_colour_of((float)i / 200, rgb);
        for (int c = 0; c < 3; c++) assert_true(rgb[c] >= 0 && rgb[c] <= 1);
        double y = luminance_of_code(rgb);
        assert_true(y > last);
        last = y;
    }
    assert_true(last > 0.8);
}

ARENA_TEST(false_colours_show_the_value_by_the_scale) {
    const float values[6] = {0.1f, 1, 10, 100, 1000, NAN};
    ScaleRange range = {0.1f, 1000, true};
    Picture p = false_colour_picture(values, 6, 1, range, "cd/m^2", &arena);
    assert_true(p.width > 6 && p.height == 1);
    for (int i = 0; i < 5; i++) {
        float want[3];
        assert_near(scale_position(range, values[i]), i / 4.0, 1e-6);
        false_colour_of((float)i / 4, want);
        for (int c = 0; c < 3; c++) assert_near(picture_pixel(&p, i, 0)[c], want[c], 1e-3);
    }
    assert_true(scale_position(range, -1) == 0 && scale_position(range, 0) == 0);
    assert_true(scale_position(range, INFINITY) == 1);
}

ARENA_TEST(a_scale_has_round_ends_around_the_values) {
    enum { N = 10000 };
    static float values[N];
    for (int i = 0; i < N; i++) values[i] = (float)exp(log(0.03) + i * log(7000 / 0.03) / N);
    ScaleRange r = scale_range_of(values, N, true, arena);
    assert_close(r.low, 0.05, 1e-5); /* the 5th percentile is 0.056 */
    assert_close(r.high, 10000, 1e-5);
    for (int i = 0; i < N; i++) values[i] = 5;
    r = scale_range_of(values, N, true, arena);
    assert_close(r.high, 5, 1e-5);
    assert_close(r.low, 0.05, 1e-5);
    for (int i = 0; i < N; i++) values[i] = i == 0 ? NAN : (float)i * 0.0088f;
    r = scale_range_of(values, N, false, arena);
    assert_true(r.low == 0 && r.high == 100);
    values[0] = NAN;
    r = scale_range_of(values, 1, true, arena);
    assert_true(r.low > 0 && r.high > r.low);
}

ARENA_TEST(letters_are_drawn_as_wide_as_they_are_said_to_be) {
    static const char TEXT[] = "0123456789.-+/:%()abcdefghijklmnopqrstuvwxyz";
    StrokeFont font = {24, {1, 1, 1}};
    for (size_t i = 0; i + 1 < sizeof TEXT; i++) {
        char text[2] = {TEXT[i], 0};
        Picture p = picture_create(60, 60, &arena);
        float width = stroke_font_draw(NULL, font, 0, 0, text);
        int ink = 0;
        stroke_font_draw(&p, font, 12, 30, text);
        for (int k = 0; k < 3600; k++) {
            if (!(p.rgb[3 * k] > 0.5f)) continue;
            ink++;
            assert_true((float)(k % 60) > 12 - 8 && (float)(k % 60) < 12 + width + 1);
        }
        assert_true(ink > 8);
    }
    static const char *const WORDS[] = {"0", "00", "1", "8", "2", "^2"};
    float width[6];
    for (int i = 0; i < 6; i++) width[i] = stroke_font_draw(NULL, font, 0, 0, WORDS[i]);
    assert_near(width[1], 2 * width[0], 1e-3);
    assert_near(width[2], width[3], 1e-3);
    assert_true(width[5] < width[4]);
}

/* ---- colour spaces ----------------------------------------------------------------------- */

TEST(primaries_give_the_published_matrix) {
    /* ITU-R BT.709 with D65, as in IEC 61966-2-1 to four digits. */
    static const double WANT[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    ColourMatrix m = xyz_from_primaries(REC709_CHROMATICITIES);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) assert_near(m.m[i][j], WANT[i][j], 1e-4);
    ColourMatrix one = rec709_from_primaries(REC709_CHROMATICITIES);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) assert_near(one.m[i][j], i == j, 1e-12);
    assert_false(chromaticities_are_usable((double[8]){.1, .1, .2, .2, .3, .3, .33, .33}));
    assert_false(chromaticities_are_usable((double[8]){NAN}));
}

static uint32_t u32_at(const unsigned char *p) {
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* A value of a tag whose values begin 8 bytes into it, NaN when there is no such tag. */
static double icc_value(IccProfile profile, const char *tag, int i) {
    const unsigned char *bytes = profile.bytes;
    for (uint32_t k = 0; k < u32_at(bytes + 128); k++) {
        const unsigned char *entry = bytes + 132 + 12 * k;
        uint32_t at = u32_at(entry + 4), size = u32_at(entry + 8);
        assert_true(at % 4 == 0 && at + size <= profile.size);
        if (!memcmp(entry, tag, 4)) return (int32_t)u32_at(bytes + at + 8 + 4 * i) / 65536.0;
    }
    return (double)NAN;
}

/* The columns of sRGB adapted to D50, as the ICC's own sRGB profiles have them. */
ARENA_TEST(the_profile_holds_the_published_primaries) {
    static const char *const TAGS[3] = {"rXYZ", "gXYZ", "bXYZ"};
    static const double WANT[3][3] = {
        {0.4361, 0.2225, 0.0139}, {0.3851, 0.7169, 0.0971}, {0.1431, 0.0606, 0.7141}};
    IccProfile p = icc_profile_create(REC709_CHROMATICITIES, ICC_CURVE_SRGB, "test", &arena);
    assert_int_equal(u32_at(p.bytes), p.size);
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            assert_near(icc_value(p, TAGS[k], c), WANT[k][c], 2e-4);
            sum += icc_value(p, TAGS[k], c);
        }
        assert_near(sum, icc_value(p, "wtpt", c), 1e-4);
    }
    assert_near(icc_value(p, "gTRC", 1), 2.4, 1e-4); /* behind the curve's kind */
}

TEST_PROGRAM(make_arena, drop_arena)
