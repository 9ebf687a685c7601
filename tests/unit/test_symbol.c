/* SPDX-License-Identifier: Apache-2.0 */
/* What of a symbol is foreground and what background. */
#include "symbol_fixture.h"

#include "base/units.h"
#include "review/symbol/symbol.h"

static const double LIGHT[2] = {1, 0}, DARK[2] = {0, 1};

static SymbolQuestion question_about(const Easel *easel, const Image *content) {
    return (SymbolQuestion){.panel = easel->panel, .content = content, .uv = {0, 0, 1, 1}};
}

static SymbolSplit split_of(Easel *easel, const SymbolQuestion *question) {
    SymbolSplit split;
    assert_done(symbol_split(question, &easel->arena, &split, &err));
    return split;
}

static void assert_refused(Easel *easel, const SymbolQuestion *question, const char *text) {
    SymbolSplit split;
    if (symbol_split(question, &easel->arena, &split, why())) fail_msg("no \"%s\"", text);
    if (!strstr(why()->text, text)) fail_msg("\"%s\" says not \"%s\"", why()->text, text);
}

/* Edges at quarters of pixels: neither class has any of them. */
EASEL_TEST(edges_that_are_covered_in_part_are_in_neither_class) {
    Boxes bars = {3, {{10.25, 12, 14.5, 60}, {20.75, 12.5, 26.25, 59.75}, {33, 20, 36, 50}}};
    double white = easel_luminance(easel, 255), black = easel_luminance(easel, 0);
    Image image = easel_draw(easel, 64, 72, LIGHT, boxes_coverage, &bars);
    SymbolQuestion question = question_about(easel, &image);
    SymbolSplit split = split_of(easel, &question);
    assert_true(split.is_light_on_dark);
    assert_close(split.foreground_cd_m2, white, 1e-6);
    assert_close(split.background_cd_m2, black, 1e-6);
    assert_int_equal(split.foreground_count, 3 * 48 + 5 * 46 + 3 * 30);
    assert_int_equal(split.foreground_count + split.background_count + split.edge_count, 64 * 72);
    assert_true(split.edge_count > 0);
    assert_true(split.separability > SYMBOL_SEPARABLE);
}

/* The classes point at the pixels that were drawn. */
EASEL_TEST(each_pixel_has_its_class) {
    Boxes bar = {1, {{8, 8.5, 12, 24}}};
    Image image = easel_draw(easel, 40, 32, LIGHT, boxes_coverage, &bar);
    SymbolQuestion question = question_about(easel, &image);
    question.uv[0] = 0.1; /* pixels 4 .. 39 */
    SymbolSplit split = split_of(easel, &question);
    assert_int_equal(split.light.x, 4);
    assert_int_equal(split.light.width, 36);
    for (int y = 0; y < 32; y++)
        for (int x = 0; x < 36; x++) {
            double share = boxes_coverage(&bar, x + 4, y);
            SymbolClass wanted = share == 1   ? SYMBOL_FOREGROUND
                                 : share == 0 ? SYMBOL_BACKGROUND
                                              : SYMBOL_EDGE;
            assert_int_equal(split.class_of[36 * y + x], wanted);
        }
}

EASEL_TEST(box_and_height_count_edges_by_their_share) {
    Boxes bar = {1, {{10.25, 12.75, 30.5, 40.5}}};
    Image image = easel_draw(easel, 60, 50, LIGHT, boxes_coverage, &bar);
    SymbolQuestion question = question_about(easel, &image);
    question.uv[1] = 0.1;
    SymbolSplit split = split_of(easel, &question);
    assert_near(60 * split.box[0], 10.25, 0.01);
    assert_near(50 * split.box[1], 12.75, 0.01);
    assert_near(60 * split.box[2], 30.5, 0.01);
    assert_near(50 * split.box[3], 40.5, 0.01);
    assert_near(50 * split.character_v, 27.75, 0.02);
}

/* Two lines: characters of 40 and 38 with a dot, and smaller ones below. */
EASEL_TEST(a_character_is_as_high_as_those_of_the_tallest_line) {
    Boxes text = {7,
                  {{10, 10, 16, 50},
                   {25, 10, 31, 50},
                   {40, 12, 46, 50},
                   {55, 44, 61, 50},
                   {10, 70, 14, 90},
                   {20, 70, 24, 90},
                   {30, 70, 34, 90}}};
    Image image = easel_draw(easel, 80, 100, LIGHT, boxes_coverage, &text);
    SymbolQuestion question = question_about(easel, &image);
    SymbolSplit split = split_of(easel, &question);
    assert_near(100 * split.character_v, 40, 1e-3);
    assert_near(100 * (split.box[3] - split.box[1]), 80, 1e-3);
}

/* The gaps between the segments of an E are a quarter of its strokes. */
EASEL_TEST(segments_make_one_character) {
    Boxes text = {
        5,
        {{10, 10, 18, 43}, {10, 45, 18, 78}, {20, 2, 44, 10}, {20, 40, 44, 48}, {20, 78, 44, 86}}};
    Image image = easel_draw(easel, 60, 100, LIGHT, boxes_coverage, &text);
    SymbolQuestion question = question_about(easel, &image);
    SymbolSplit split = split_of(easel, &question);
    assert_near(split.stroke_px, 8, 1e-6);
    assert_near(100 * split.character_v, 84, 1e-3);
}

/* The shortest of four chords is at most 1 / cos 22.5 degrees too long. */
EASEL_TEST(strokes_have_the_width_that_was_drawn) {
    const double widths[] = {3, 4.6, 7.3}, degrees[] = {0, 10, 22.5, 45, 70, 90, 135};
    for (int w = 0; w < 3; w++)
        for (int a = 0; a < 7; a++) {
            double angle = radians_from_degrees(degrees[a]);
            Stroke stroke = {{60.3, 59.6}, angle, 90, widths[w]};
            Image image = easel_draw(easel, 120, 120, LIGHT, stroke_coverage, &stroke);
            SymbolQuestion question = question_about(easel, &image);
            SymbolSplit split = split_of(easel, &question);
            double off = fabs(remainder(degrees[a], 45));
            double chord = widths[w] / cos(radians_from_degrees(off));
            assert_close(split.stroke_px, chord, 0.03);
            assert_close(split.foreground_cd_m2, easel_luminance(easel, 255), 0.01);
            easel->arena = easel->fresh;
        }
}

/* A stroke of one pixel that lies over two keeps the better one. */
EASEL_TEST(a_stroke_thinner_than_a_pixel_keeps_what_it_shows) {
    Boxes bar = {1, {{20.3, 5, 21.3, 45}}};
    double white = easel_luminance(easel, 255), black = easel_luminance(easel, 0);
    Image image = easel_draw(easel, 40, 50, LIGHT, boxes_coverage, &bar);
    SymbolQuestion question = question_about(easel, &image);
    SymbolSplit split = split_of(easel, &question);
    assert_close(split.foreground_cd_m2, black + 0.7 * (white - black), 0.01);
    assert_close(split.background_cd_m2, black, 1e-6);
    assert_int_equal(split.foreground_count, 40);
}

EASEL_TEST(the_smaller_class_is_the_foreground_unless_it_is_said) {
    Boxes bar = {1, {{20, 5, 26, 45}}};
    double white = easel_luminance(easel, 255), black = easel_luminance(easel, 0);
    Image dark = easel_draw(easel, 60, 50, DARK, boxes_coverage, &bar);
    SymbolQuestion question = question_about(easel, &dark);
    for (int k = 0; k < 2; k++) {
        question.polarity = k ? POLARITY_DARK_ON_LIGHT : POLARITY_AUTO;
        SymbolSplit split = split_of(easel, &question);
        assert_false(split.is_light_on_dark);
        assert_close(split.foreground_cd_m2, black, 1e-6);
        assert_int_equal(split.foreground_count, 6 * 40);
        assert_close(split.stroke_px, 6, 1e-6);
    }
    question.polarity = POLARITY_LIGHT_ON_DARK;
    SymbolSplit split = split_of(easel, &question);
    assert_true(split.is_light_on_dark);
    assert_close(split.foreground_cd_m2, white, 1e-6);
    assert_int_equal(split.foreground_count, 60 * 50 - 6 * 40);
}

/* White with a grey bar and alpha: left half told, right half left out. */
static Image mask_of(Easel *easel, int width, int height) {
    uint8_t *pixels = ARENA_NEW(&easel->arena, uint8_t, 4 * width * height);
    for (int i = 0; i < width * height; i++) {
        int x = i % width, grey = x < 10 ? 255 : x < 12 ? 128 : 0;
        memset(pixels + 4 * i, grey, 3);
        pixels[4 * i + 3] = x < width / 2 ? 255 : 0;
    }
    return (Image){width, height, IMAGE_RGBA8, pixels};
}

EASEL_TEST(a_mask_says_the_classes) {
    Boxes bar = {1, {{0, 0, 20, 30}}};
    double ink_ground[2] = {0.5, 0.2};
    Image image = easel_draw(easel, 60, 30, ink_ground, boxes_coverage, &bar);
    Image mask = mask_of(easel, 60, 30);
    double white = easel_luminance(easel, 255), black = easel_luminance(easel, 0);
    double bright = black + 0.5 * (white - black), dim = black + 0.2 * (white - black);
    SymbolQuestion question = question_about(easel, &image);
    question.mask = &mask;
    SymbolSplit split = split_of(easel, &question);
    assert_int_equal(split.foreground_count, 10 * 30);
    assert_int_equal(split.background_count, 18 * 30);
    assert_int_equal(split.edge_count, 32 * 30);
    assert_close(split.foreground_cd_m2, bright, 1e-3);
    assert_close(split.background_cd_m2, (8 * bright + 10 * dim) / 18, 1e-3);
    assert_true(isnan(split.separability));
    question.polarity = POLARITY_DARK_ON_LIGHT;
    assert_refused(easel, &question, "the mask's foreground is light on dark");
    question.polarity = POLARITY_AUTO;
    question.uv[0] = 0.55;
    assert_refused(easel, &question, "the mask is nowhere white there");
    question.uv[0] = 0;
    question.uv[2] = 0.15;
    assert_refused(easel, &question, "the mask is nowhere black there");
    mask.height = 20;
    assert_refused(easel, &question, "the mask has 60 x 20 pixels, its content 60 x 30");
}

EASEL_TEST(what_holds_no_symbol_is_said_in_a_line) {
    Boxes bar = {1, {{20, 5, 26, 45}}};
    Image image = easel_draw(easel, 60, 50, LIGHT, boxes_coverage, &bar);
    static const struct {
        double uv[4];
        const char *text;
    } cases[] = {
        {{-0.1, 0, 1, 1}, "uv [-0.1, 0, 1, 1]: the rectangle leaves its content, 0 to 1"},
        {{0, 0, 1, 1.001}, "the rectangle leaves its content"},
        {{0, 0, (double)NAN, 1}, "the rectangle leaves its content"},
        {{0.5, 0, 0.5, 1}, "the rectangle is empty; left < right and top < bottom"},
        {{0, 0.8, 1, 0.2}, "the rectangle is empty"},
        {{0.5, 0.5, 0.501, 0.501}, "holds no pixel of its content of 60 x 50"},
        {{0.5, 0.5, 0.54, 0.54}, "fewer than 16 pixels"},
        {{0.6, 0, 1, 1}, "everything in the rectangle has one luminance"},
    };
    SymbolQuestion question = question_about(easel, &image);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        memcpy(question.uv, cases[i].uv, sizeof question.uv);
        assert_refused(easel, &question, cases[i].text);
    }
    Boxes speck = {1, {{20, 5, 22, 7}}};
    image = easel_draw(easel, 60, 50, LIGHT, boxes_coverage, &speck);
    question = question_about(easel, &image);
    assert_refused(easel, &question, "nearly everything in the rectangle has one luminance");
    question.content = NULL;
    assert_refused(easel, &question, "the display has no content: it shows white alone");
}

TEST_PROGRAM(easel_open, easel_close)
