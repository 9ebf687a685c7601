/* SPDX-License-Identifier: Apache-2.0 */
/* The contrast of what a picture shows, on made-up text of known luminance. */
#include "fixture.h"

#include "image/content_contrast.h"

enum { WIDTH = 156, HEIGHT = 60 };

/* A picture of bars that look like text: strokes `stroke` pixels wide (one pixel of half
 * coverage at either side), every 12 pixels, in lines of 12 of 20 rows. */
typedef struct Page {
    double characters, ground;
    int stroke;
    double sigma, slope; /* noise of a pixel; the ground's relative change across the page */
    bool is_blank;
} Page;

/* A normal number, of twelve uniform ones. */
static double normal(unsigned *seed) {
    double sum = -6;
    for (int k = 0; k < 12; k++) {
        *seed = *seed * 1664525u + 1013904223u;
        sum += (double)(*seed >> 8) / (1 << 24);
    }
    return sum;
}

static double coverage(const Page *page, int x, int y) {
    int at = x % 12;
    if (page->is_blank || y % 20 < 4 || y % 20 >= 16) return 0;
    if (at < 2 || at > 3 + page->stroke) return 0;
    return at == 2 || at == 3 + page->stroke ? 0.5 : 1;
}

static ContentPixels print_page(const Page *page, bool knows_noise, unsigned *seed, Arena *arena) {
    float *luminance = ARENA_NEW(arena, float, WIDTH *HEIGHT);
    float *variance = ARENA_NEW(arena, float, WIDTH *HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int x = i % WIDTH, y = i / WIDTH;
        double c = coverage(page, x, y);
        double ground = page->ground * (1 + page->slope * ((double)x / WIDTH - 0.5));
        luminance[i] =
            (float)(c * page->characters + (1 - c) * ground + page->sigma * normal(seed));
        variance[i] = (float)(page->sigma * page->sigma);
    }
    return (ContentPixels){WIDTH, HEIGHT, luminance, knows_noise ? variance : NULL};
}

static ContentContrast read_page(Page page, bool knows_noise, unsigned *seed, Arena arena) {
    ContentPixels pixels = print_page(&page, knows_noise, seed, &arena);
    return content_contrast(&pixels, arena);
}

ARENA_TEST(text_without_noise_has_its_contrast) {
    unsigned seed = 1;
    static const double pairs[][2] = {{400, 4}, {4, 400}, {100, 80}, {1, 0.001}, {1e4, 9e3}};
    for (int i = 0; i < 5; i++) {
        for (int stroke = 3; stroke < 6; stroke++) {
            double c = pairs[i][0], g = pairs[i][1], high = fmax(c, g), low = fmin(c, g);
            Page page = {c, g, stroke, 0, 0, false};
            ContentContrast m = read_page(page, false, &seed, arena);
            assert_int_equal(m.verdict, CONTENT_FOUND);
            assert_true(m.edges_left_out && m.character_pixels < m.ground_pixels);
            assert_close(m.characters.value, c, 1e-6);
            assert_close(m.ground.value, g, 1e-6);
            assert_close(m.ratio.value, high / low, 1e-5);
            assert_close(m.michelson.value, (high - low) / (high + low), 1e-5);
            assert_close(m.weber.value, (c - g) / g, 1e-5);
            assert_true(isnan(measured_half_width(m.ratio)) && isnan(m.noise_sigmas));
        }
    }
}

/* A firefly, or a hole, among 9600 pixels does not move the split. */
ARENA_TEST(single_pixels_do_not_move_the_split) {
    unsigned seed = 1;
    Page page = {200, 20, 4, 0, 0, false};
    ContentPixels pixels = print_page(&page, false, &seed, &arena);
    ((float *)pixels.luminance)[5] = 1e7f;
    ((float *)pixels.luminance)[700] = -50;
    ContentContrast m = content_contrast(&pixels, arena);
    assert_int_equal(m.verdict, CONTENT_FOUND);
    assert_true(m.threshold > 20 && m.threshold < 200);
    assert_close(m.ground.value, 20, 0.01);
}

ARENA_TEST(strokes_too_thin_are_told_and_understate) {
    unsigned seed = 1;
    ContentContrast m = read_page((Page){300, 10, 0, 0, 0, false}, false, &seed, arena);
    assert_int_equal(m.verdict, CONTENT_FOUND);
    assert_false(m.edges_left_out);
    assert_true(m.ratio.value > 5 && m.ratio.value < 30);
}

/* The noise's interval holds 95 of 100 times, for every figure. */
ARENA_TEST(the_intervals_cover) {
    enum { TRIALS = 400 };
    unsigned seed = 11;
    const Page pages[] = {{100, 20, 4, 8, 0, false}, {20, 100, 4, 8, 0, false}};
    for (int p = 0; p < 2; p++) {
        double c = pages[p].characters, g = pages[p].ground;
        double truth[5] = {c, g, 5, 80.0 / 120, (c - g) / g};
        int inside[5] = {0};
        for (int trial = 0; trial < TRIALS; trial++) {
            ContentContrast m = read_page(pages[p], true, &seed, arena);
            assert_int_equal(m.verdict, CONTENT_FOUND);
            const Measured *figures[5] = {&m.characters, &m.ground, &m.ratio, &m.michelson,
                                          &m.weber};
            for (int k = 0; k < 5; k++)
                inside[k] += figures[k]->low <= truth[k] && truth[k] <= figures[k]->high;
        }
        for (int k = 0; k < 5; k++) assert_near(inside[k] / (double)TRIALS, 0.95, 0.04);
    }
}

ARENA_TEST(noise_and_slopes_are_no_text) {
    unsigned seed = 3;
    Page uniform = {100, 100, 4, 5, 0, false}, slope = {100, 100, 3, 0, 1, false};
    assert_int_equal(read_page(uniform, true, &seed, arena).verdict, CONTENT_NOISY);
    assert_int_equal(read_page(uniform, false, &seed, arena).verdict, CONTENT_NOT_TWO);
    slope.is_blank = true;
    for (int knows_noise = 0; knows_noise < 2; knows_noise++)
        assert_int_equal(read_page(slope, knows_noise, &seed, arena).verdict, CONTENT_NOT_TWO);
    uniform.sigma = 0;
    assert_int_equal(read_page(uniform, true, &seed, arena).verdict, CONTENT_TOO_SMALL);
    ContentContrast m = read_page((Page){100, 50, 5, 10, 0, false}, true, &seed, arena);
    assert_int_equal(m.verdict, CONTENT_NOISY);
    assert_close(m.noise_sigmas, 5, 0.1);
    float pixel[15] = {1, 2, 1, 2};
    assert_int_equal(content_contrast(&(ContentPixels){15, 1, pixel, NULL}, arena).verdict,
                     CONTENT_TOO_SMALL);
}

/* Text on a ground that is brighter at one side: the mean ground counts. */
ARENA_TEST(a_ground_that_is_not_even_has_its_mean) {
    unsigned seed = 5;
    ContentContrast m = read_page((Page){200, 20, 4, 1, 0.4, false}, true, &seed, arena);
    assert_int_equal(m.verdict, CONTENT_FOUND);
    assert_close(m.ground.value, 20, 0.01);
    assert_close(m.characters.value, 200, 0.01);
}

TEST_PROGRAM(make_arena, drop_arena)
