/* SPDX-License-Identifier: Apache-2.0 */
/* Pixel errors, SSIM, CIEDE2000 and ranks. */
#include "fixture.h"

#include <stdlib.h>
#include <string.h>

#include "compare/metrics/deltae.h"
#include "compare/metrics/lab.h"
#include "compare/metrics/pixel_errors.h"
#include "compare/metrics/rank.h"
#include "compare/metrics/ssim.h"
#include "planes_fixture.h"

/* ---- ranks ---- */

static int compare_floats(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

TEST(ranks_are_those_of_sorting) {
    float values[501], sorted[501];
    uint64_t seed = 3;
    for (int i = 0; i < 501; i++) {
        double magnitude = pow(10, 60 * fixture_random(&seed) - 30);
        values[i] = sorted[i] = (float)(i % 50 ? magnitude * (i % 3 - 1) : -0.0);
    }
    qsort(sorted, 501, sizeof *sorted, compare_floats);
    for (int rank = 1; rank <= 501; rank++)
        assert_near(rank_value(values, 501, NULL, rank / 501.0 - 1e-9), sorted[rank - 1], 0);
    assert_near(rank_value(values, 501, NULL, 0), sorted[0], 0);
    assert_near(rank_value(values, 501, NULL, 1), sorted[500], 0);
}

TEST(ranks_keep_to_the_mask) {
    const float values[5] = {9, -2, 4, -7, 1};
    unsigned char mask[5] = {0, 1, 1, 0, 7};
    assert_near(rank_value(values, 5, mask, 0), -2, 0);
    assert_near(rank_value(values, 5, mask, 0.5), 1, 0);
    assert_near(rank_value(values, 5, mask, 1), 4, 0);
    memset(mask, 0, sizeof mask);
    assert_true(isnan(rank_value(values, 5, mask, 0.5)));
    assert_true(isnan(rank_value(values, 0, NULL, 0.5)));
}

/* ---- pixel errors ---- */

static PixelErrors errors_of(const Canvas *r, const Canvas *t, PixelMask mask, bool is_light,
                             Arena arena) {
    return pixel_errors_measure(&r->planes, &t->planes, mask, is_light, arena);
}

ARENA_TEST(equal_pictures_have_no_error) {
    const Canvas scene = canvas_scene(50, 40, 0.3, 1, &arena);
    PixelErrors e = errors_of(&scene, &scene, NULL, false, arena);
    assert_near(e.mae, 0, 0);
    assert_near(e.mse, 0, 0);
    assert_near(e.rel_mse, 0, 0);
    assert_near(e.max_difference, 0, 0);
    assert_near(e.mean_shift, 0, 0);
    assert_true(isinf(e.psnr_db) && e.psnr_db > 0);
    assert_near(e.peak, 1, 0);
}

/* Grey 0.5 against grey 0.75: e is a hundredth of 0.5. */
ARENA_TEST(even_pictures_follow_the_closed_forms) {
    const Canvas r = canvas_uniform(0.5f, 0.5f, 0.5f, &arena);
    const Canvas t = canvas_uniform(0.75f, 0.75f, 0.75f, &arena);
    PixelErrors e = errors_of(&r, &t, NULL, false, arena);
    assert_close(e.mae, 0.25, 1e-12);
    assert_close(e.mse, 0.0625, 1e-12);
    assert_close(e.rel_mse, 0.0625 / (0.25 + 0.005 * 0.005), 1e-7);
    assert_close(e.max_difference, 0.25, 1e-12);
    assert_close(e.psnr_db, 12.041199826559248, 1e-12);
    assert_close(e.mean_shift, 0.5, 1e-6);
}

/* One channel in one pixel of 108 is off. */
ARENA_TEST(one_pixel_is_one_of_all) {
    const Canvas r = canvas_uniform(1, 1, 1, &arena), t = canvas_uniform(1, 1, 1, &arena);
    t.rgb[2][17] = -2;
    PixelErrors e = errors_of(&r, &t, NULL, false, arena);
    assert_close(e.mae, 3 / (3.0 * 108), 1e-12);
    assert_close(e.mse, 9 / (3.0 * 108), 1e-12);
    assert_close(e.rel_mse, 9 / 1.0001 / (3.0 * 108), 1e-6);
    assert_near(e.max_difference, 3, 0);
    assert_close(e.mean_shift, -3 * 0.0722 / 108, 1e-3);
}

/* 999 of 1000 pixels are not above 40: the sun of 1e9 does not set the peak of a frame. */
ARENA_TEST(a_frame_has_its_own_peak) {
    const Canvas r = canvas_create(50, 20, &arena), t = canvas_create(50, 20, &arena);
    canvas_fill(&r, 40, 40, 40);
    canvas_fill(&t, 42, 42, 42);
    for (int c = 0; c < 3; c++) r.rgb[c][7] = t.rgb[c][7] = 1e9f;
    PixelErrors e = errors_of(&r, &t, NULL, true, arena);
    assert_close(e.peak, 40, 1e-6);
    assert_close(e.mse, 4 * 0.999, 1e-12);
    assert_close(e.psnr_db, 10 * log10(1600 / (4 * 0.999)), 1e-6);
    assert_near(errors_of(&r, &t, NULL, false, arena).peak, 1, 0);
}

ARENA_TEST(errors_grow_with_the_unit_of_light) {
    const Canvas r = canvas_scene(50, 40, 0.3, 1, &arena);
    const Canvas t = canvas_scene(50, 40, 0.3, 2, &arena);
    const Canvas r4 = canvas_scaled(&r, 4, &arena), t4 = canvas_scaled(&t, 4, &arena);
    PixelErrors a = errors_of(&r, &t, NULL, true, arena);
    PixelErrors b = errors_of(&r4, &t4, NULL, true, arena);
    assert_close(b.mae, 4 * a.mae, 1e-12);
    assert_close(b.mse, 16 * a.mse, 1e-12);
    assert_close(b.rel_mse, a.rel_mse, 1e-6);
    assert_close(b.psnr_db, a.psnr_db, 1e-6);
    assert_close(b.peak, 4 * a.peak, 1e-6);
    assert_true(a.rel_mse > 0.01);
}

ARENA_TEST(a_black_reference_is_told_apart) {
    const Canvas black = canvas_uniform(0, 0, 0, &arena);
    const Canvas grey = canvas_uniform(1, 1, 1, &arena);
    PixelErrors same = errors_of(&black, &black, NULL, true, arena);
    PixelErrors other = errors_of(&black, &grey, NULL, true, arena);
    assert_near(same.rel_mse, 0, 0);
    assert_near(same.mean_shift, 0, 0);
    assert_true(isinf(same.psnr_db) && same.psnr_db > 0);
    assert_true(isinf(other.rel_mse));
    assert_true(isinf(other.mean_shift));
    assert_true(isinf(other.psnr_db) && other.psnr_db < 0);
    assert_near(other.peak, 0, 0);
}

/* Whatever stands behind the mask: not one bit of any figure changes. */
ARENA_TEST(masked_pixels_count_for_nothing) {
    const Canvas r = canvas_scene(40, 30, 0.3, 1, &arena);
    const Canvas t = canvas_scene(40, 30, 0.3, 2, &arena);
    const Canvas spoilt = canvas_scene(40, 30, 0.3, 2, &arena);
    unsigned char *mask = ARENA_NEW(&arena, unsigned char, 40 * 30);
    float *map = ARENA_NEW(&arena, float, 40 * 30);
    for (int i = 0; i < 40 * 30; i++) mask[i] = i % 40 > 9 || i / 40 > 9;
    for (int i = 0; i < 40 * 30; i++)
        if (!mask[i]) spoilt.rgb[i % 3][i] = (float)(50 - i % 100);
    PixelErrors a = errors_of(&r, &t, mask, true, arena);
    PixelErrors b = errors_of(&r, &spoilt, mask, true, arena);
    assert_memory_equal(&a, &b, sizeof a);
    PixelErrors c = errors_of(&t, &r, mask, true, arena);
    PixelErrors d = errors_of(&spoilt, &r, mask, true, arena);
    assert_memory_equal(&c, &d, sizeof c);
    assert_near(ssim_mean(&r.planes, &t.planes, mask, NULL, arena),
                ssim_mean(&r.planes, &spoilt.planes, mask, NULL, arena), 0);
    assert_near(ssim_mean(&t.planes, &r.planes, mask, NULL, arena),
                ssim_mean(&spoilt.planes, &r.planes, mask, NULL, arena), 0);
    MapSummary e = deltae_pictures(&r.planes, &t.planes, mask, map);
    MapSummary f = deltae_pictures(&r.planes, &spoilt.planes, mask, map);
    assert_memory_equal(&e, &f, sizeof e);
    assert_true(a.mse > 0.01 && e.mean > 1);
    assert_true(errors_of(&r, &spoilt, NULL, true, arena).mse > 2 * a.mse);
}

ARENA_TEST(no_pixel_gives_no_number) {
    const Canvas r = canvas_uniform(1, 2, 3, &arena);
    unsigned char *mask = ARENA_NEW(&arena, unsigned char, 12 * 9);
    float map[12 * 9];
    PixelErrors e = errors_of(&r, &r, mask, true, arena);
    MapSummary d = deltae_pictures(&r.planes, &r.planes, mask, map);
    assert_true(isnan(e.mae) && isnan(e.mse) && isnan(e.rel_mse) && isnan(e.max_difference));
    assert_true(isnan(e.psnr_db) && isnan(e.peak) && isnan(e.mean_shift));
    assert_true(isnan(errors_of(&r, &r, mask, false, arena).psnr_db));
    assert_true(isnan(d.mean) && isnan(d.p95) && isnan(d.max));
    assert_true(isnan(ssim_mean(&r.planes, &r.planes, mask, map, arena)));
    for (int i = 0; i < 12 * 9; i++) assert_near(map[i], 1, 0);
}

/* ---- SSIM ---- */

static double ssim_of(const Canvas *r, const Canvas *t, Arena arena) {
    return ssim_mean(&r->planes, &t->planes, NULL, NULL, arena);
}

ARENA_TEST(equal_pictures_are_similar) {
    const Canvas scene = canvas_scene(50, 40, 0.3, 1, &arena);
    float *map = ARENA_NEW(&arena, float, 50 * 40);
    assert_near(ssim_mean(&scene.planes, &scene.planes, NULL, map, arena), 1, 0);
    for (int i = 0; i < 50 * 40; i++) assert_near(map[i], 1, 0);
}

/* A hole in a picture is no part of it, not a black one. */
ARENA_TEST(holes_do_not_show) {
    const Canvas r = canvas_uniform(0.5f, 0.5f, 0.5f, &arena);
    const Canvas t = canvas_uniform(0.25f, 0.25f, 0.25f, &arena);
    unsigned char mask[12 * 9];
    float map[12 * 9];
    for (int i = 0; i < 12 * 9; i++) mask[i] = i % 12 > 3 && i % 7 != 0;
    ssim_mean(&r.planes, &t.planes, mask, map, arena);
    for (int i = 0; i < 12 * 9; i++) assert_close(map[i], 0.2501 / 0.3126, 1e-6);
}

/* No contrast: what is left is (2 r t + C1) / (r^2 + t^2 + C1). */
ARENA_TEST(even_pictures_differ_by_luminance) {
    const Canvas r = canvas_uniform(0.5f, 0.5f, 0.5f, &arena);
    const Canvas t = canvas_uniform(0.25f, 0.25f, 0.25f, &arena);
    assert_close(ssim_of(&r, &t, arena), 0.2501 / 0.3126, 1e-12);
    const Canvas red = canvas_uniform(1, 0, 0, &arena), blue = canvas_uniform(0, 0, 1, &arena);
    double a = 0.299, b = 0.114, expected = (2 * a * b + 1e-4) / (a * a + b * b + 1e-4);
    assert_close(ssim_of(&red, &blue, arena), expected, 1e-12);
}

/* A pattern of greys about the same mean, with half of the contrast: wherever the window's mean
 * is m + d and its variance v, the test's are m + d / 2 and v / 4. For stripes of one pixel
 * the window sees all of the mean but 1e-3 of the amplitude. */
ARENA_TEST(contrast_counts_by_its_own_term) {
    const Canvas r = canvas_create(41, 41, &arena), t = canvas_create(41, 41, &arena);
    float *map = ARENA_NEW(&arena, float, 41 * 41);
    for (int i = 0; i < 41 * 41; i++)
        for (int c = 0; c < 3; c++) {
            float wave = (i % 41 + i / 41) % 2 ? 0.25f : -0.25f;
            r.rgb[c][i] = 0.5f + wave;
            t.rgb[c][i] = 0.5f + wave / 2;
        }
    ssim_mean(&r.planes, &t.planes, NULL, map, arena);
    double v = 0.0625, expected = (v + 9e-4) / (v + v / 4 + 9e-4); /* 2 cov = 2 v / 2 */
    assert_near(map[20 * 41 + 20], expected, 1e-5);
}

static double direct_ssim(const Canvas *r, const Canvas *t, int px, int py) {
    const int width = r->planes.width, height = r->planes.height;
    double w = 0, mr = 0, mt = 0, vr = 0, vt = 0, cov = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int y = py - 5; y <= py + 5; y++)
            for (int x = px - 5; x <= px + 5; x++) {
                if (x < 0 || y < 0 || x >= width || y >= height) continue;
                int i = y * width + x;
                double g = exp(-((x - px) * (x - px) + (y - py) * (y - py)) / 4.5);
                double a = 0.299 * r->rgb[0][i] + 0.587 * r->rgb[1][i] + 0.114 * r->rgb[2][i];
                double b = 0.299 * t->rgb[0][i] + 0.587 * t->rgb[1][i] + 0.114 * t->rgb[2][i];
                if (pass == 0) {
                    w += g;
                    mr += g * a;
                    mt += g * b;
                } else {
                    vr += g * (a - mr / w) * (a - mr / w) / w;
                    vt += g * (b - mt / w) * (b - mt / w) / w;
                    cov += g * (a - mr / w) * (b - mt / w) / w;
                }
            }
    mr /= w;
    mt /= w;
    double luminance = (2 * mr * mt + 1e-4) / (mr * mr + mt * mt + 1e-4);
    return luminance * (2 * cov + 9e-4) / (vr + vt + 9e-4);
}

ARENA_TEST(windows_agree_with_direct_sums) {
    const Canvas r = canvas_scene(31, 23, 0.2, 1, &arena);
    const Canvas t = canvas_scene(31, 23, 0.2, 2, &arena);
    float *map = ARENA_NEW(&arena, float, 31 * 23);
    double mean = ssim_mean(&r.planes, &t.planes, NULL, map, arena), sum = 0;
    for (int y = 0; y < 23; y++)
        for (int x = 0; x < 31; x++) {
            double expected = direct_ssim(&r, &t, x, y);
            assert_near(map[y * 31 + x], expected, 1e-6);
            sum += expected;
        }
    assert_close(mean, sum / (31 * 23), 1e-10);
    assert_true(mean > 0.2 && mean < 0.95);
}

/* ---- colours ---- */

TEST(third_roots_are_exact) {
    double worst = 0;
    for (double x = 0.008; x < 3; x *= 1.0003) {
        double error = fabs(cube_root(x) / cbrt(x) - 1);
        if (!(error <= worst)) worst = error;
    }
    assert_near(worst, 0, 2e-14);
}

static void assert_lab(float r, float g, float b, const double expected[3], double absolute) {
    double lab[3];
    const ColourMatrix ratios = relative_to_white(xyz_from_primaries(REC709_CHROMATICITIES));
    lab_from_rgb(&ratios, (const float[3]){r, g, b}, lab);
    for (int i = 0; i < 3; i++) assert_near(lab[i], expected[i], absolute);
}

/* Primaries: as published for sRGB (Lindbloom's calculator and others give these within the
 * 0.02 that D65's digits make). */
TEST(known_colours_have_their_lab) {
    assert_lab(1, 1, 1, (double[]){100, 0, 0}, 1e-11);
    assert_lab(0, 0, 0, (double[]){0, 0, 0}, 1e-11);
    assert_lab(1, 0, 0, (double[]){53.24, 80.09, 67.20}, 0.02);
    assert_lab(0, 1, 0, (double[]){87.73, -86.18, 83.18}, 0.02);
    assert_lab(0, 0, 1, (double[]){32.30, 79.19, -107.86}, 0.03);
    for (int i = 1; i < 100; i++) {
        double y = (double)((float)i / 100);
        double l = y > 0.008856451679 ? 116 * cbrt(y) - 16 : y * 903.2962962963;
        assert_lab((float)y, (float)y, (float)y, (double[]){l, 0, 0}, 1e-8);
    }
}

/* Sharma, Wu, Dalal 2005, table 1: L, a, b of two colours and their difference. */
static const double SHARMA[34][7] = {
    {50.0000, 2.6772, -79.7751, 50.0000, 0.0000, -82.7485, 2.0425},
    {50.0000, 3.1571, -77.2803, 50.0000, 0.0000, -82.7485, 2.8615},
    {50.0000, 2.8361, -74.0200, 50.0000, 0.0000, -82.7485, 3.4412},
    {50.0000, -1.3802, -84.2814, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -1.1848, -84.8006, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -0.9009, -85.5211, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, 0.0000, 0.0000, 50.0000, -1.0000, 2.0000, 2.3669},
    {50.0000, -1.0000, 2.0000, 50.0000, 0.0000, 0.0000, 2.3669},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0009, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0010, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0011, 7.2195},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0012, 7.2195},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0009, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0010, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0011, -2.4900, 4.7461},
    {50.0000, 2.5000, 0.0000, 50.0000, 0.0000, -2.5000, 4.3065},
    {50.0000, 2.5000, 0.0000, 73.0000, 25.0000, -18.0000, 27.1492},
    {50.0000, 2.5000, 0.0000, 61.0000, -5.0000, 29.0000, 22.8977},
    {50.0000, 2.5000, 0.0000, 56.0000, -27.0000, -3.0000, 31.9030},
    {50.0000, 2.5000, 0.0000, 58.0000, 24.0000, 15.0000, 19.4535},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.1736, 0.5854, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2972, 0.0000, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 1.8634, 0.5757, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2592, 0.3350, 1.0000},
    {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
    {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
    {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
    {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
    {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
    {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
    {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
    {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
    {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
    {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082},
};

TEST(published_pairs_have_their_difference) {
    for (int i = 0; i < 34; i++) {
        const double *pair = SHARMA[i];
        assert_near(deltae_2000(pair, pair + 3), pair[6], 1e-4);
        assert_near(deltae_2000(pair + 3, pair), pair[6], 1e-4);
        assert_near(deltae_2000(pair, pair), 0, 0);
    }
}

/* The same pairs as the shared data has them. */
TEST(the_file_of_pairs_agrees) {
    FILE *file = fopen(SHARED_DATA_DIR "/imgmetrics/ciede2000_sharma2005.csv", "r");
    char line[256];
    int pairs = 0;
    if (!file) {
        print_message("skipped: no shared data\n");
        skip();
    }
    while (fgets(line, sizeof line, file)) {
        double p[7];
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf", p, p + 1, p + 2, p + 3, p + 4, p + 5,
                   p + 6) != 7)
            continue;
        assert_near(deltae_2000(p, p + 3), p[6], 1e-4);
        pairs++;
    }
    fclose(file);
    assert_int_equal(pairs, 34);
}

/* White against grey: only the lightness term, (100 - L) / SL, is there. */
ARENA_TEST(pictures_have_their_difference) {
    const Canvas white = canvas_uniform(1, 1, 1, &arena);
    const Canvas mixed = canvas_uniform(1, 1, 1, &arena);
    float map[12 * 9];
    for (int i = 0; i < 10; i++)
        for (int c = 0; c < 3; c++) mixed.rgb[c][i] = 0.125f;
    double step = 100 - 42, from_grey = (71.0 - 50) * (71 - 50);
    double expected = step / (1 + 0.015 * from_grey / sqrt(20 + from_grey));
    MapSummary d = deltae_pictures(&white.planes, &mixed.planes, NULL, map);
    assert_close(d.mean, expected * 10 / 108, 1e-6);
    assert_close(d.max, expected, 1e-6);
    assert_close(d.p95, expected, 1e-6); /* ten of 108 are more than a twentieth */
    assert_near(map[10], 0, 0);
    assert_close(map[9], expected, 1e-6);
}

TEST_PROGRAM(make_arena, drop_arena)
