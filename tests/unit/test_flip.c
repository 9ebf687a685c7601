/* SPDX-License-Identifier: Apache-2.0 */
/* FLIP and HDR-FLIP: closed forms, symmetries, and a slow twin that shares no line with it. */
#include "fixture.h"

#include "compare/metrics/flip.h"
#include "compare/metrics/flip_filters.h"
#include "planes_fixture.h"
#include "flip_reference.h"

static const FlipOptions DEFAULTS = {.threads = 1};

static float *new_map(const Planes *planes, Arena *arena) {
    return ARENA_NEW(arena, float, planes_pixel_count(planes));
}

static float *ldr_map(const Canvas *reference, const Canvas *test, Arena *arena) {
    float *map = new_map(&reference->planes, arena);
    flip_ldr(&reference->planes, &test->planes, &DEFAULTS, *arena, map);
    return map;
}

static double mean_of(const Canvas *reference, const Canvas *test, Arena arena) {
    const float *map = ldr_map(reference, test, &arena);
    return map_summary(map, planes_pixel_count(&reference->planes), NULL).mean;
}

static void assert_all_near(const float *map, size_t count, double expected, double absolute) {
    for (size_t i = 0; i < count; i++) assert_near(map[i], expected, absolute);
}

ARENA_TEST(equal_pictures_have_none) {
    const Canvas scene = canvas_scene(150, 40, 0.3, 1, &arena);
    const size_t count = planes_pixel_count(&scene.planes);
    assert_all_near(ldr_map(&scene, &scene, &arena), count, 0, 0);
    float *map = new_map(&scene.planes, &arena);
    map[0] = 1;
    flip_hdr(&scene.planes, &scene.planes, &DEFAULTS, arena, map);
    assert_all_near(map, count, 0, 0);
}

typedef struct UniformPair {
    float a[3], b[3];
    double flip;
} UniformPair;

/* Worked out apart from both programs, from HyAB and the two straight lines. */
static const UniformPair PAIRS[] = {
    {{0, 1, 0}, {0, 0, 1}, 1},
    {{0, 0, 0}, {1, 1, 1}, 0.967379762},
    {{1, 0, 0}, {0, 1, 0}, 0.986662275},
    {{1, 0, 0}, {0, 0, 1}, 0.965079023},
    {{1, 1, 1}, {1, 1, 0}, 0.966308458},
    {{0.5f, 0.5f, 0.5f}, {0.25f, 0.25f, 0.25f}, 0.451849618},
    {{0.18f, 0.18f, 0.18f}, {0.2f, 0.2f, 0.2f}, 0.104366101},
    {{0, 0, 0}, {0.001f, 0.001f, 0.001f}, 0.053585358},
    {{0.2f, 0.3f, 0.4f}, {0.4f, 0.3f, 0.2f}, 0.493712002},
};

/* Even surfaces have no edges: what is left is the colour difference, in closed form. */
TEST(even_surfaces_follow_the_closed_form) {
    for (size_t i = 0; i < sizeof PAIRS / sizeof *PAIRS; i++) {
        const UniformPair p = PAIRS[i];
        Arena arena = *test_memory();
        const Canvas a = canvas_uniform(p.a[0], p.a[1], p.a[2], &arena);
        const Canvas b = canvas_uniform(p.b[0], p.b[1], p.b[2], &arena);
        assert_all_near(ldr_map(&a, &b, &arena), planes_pixel_count(&a.planes), p.flip, 2e-6);
    }
}

ARENA_TEST(light_beyond_the_display_is_clamped) {
    const Canvas a = canvas_uniform(0, 1, 0, &arena), b = canvas_uniform(-3, 7, -1, &arena);
    assert_near(mean_of(&a, &b, arena), 0, 0);
}

/* Every pixel of a picture against its slow twin. */
static double worst_against_slow(const Canvas *r, const Canvas *t, double ppd, Arena arena) {
    const FlipOptions options = {.threads = 2, .pixels_per_degree = ppd};
    SlowFlip *slow = slow_flip_create(ppd);
    float *map = new_map(&r->planes, &arena);
    double worst = 0;
    flip_ldr(&r->planes, &t->planes, &options, arena, map);
    for (int y = 0; y < r->planes.height; y++)
        for (int x = 0; x < r->planes.width; x++) {
            double expected = slow_flip_pixel(slow, &r->planes, &t->planes, x, y);
            double error = fabs((double)map[y * r->planes.width + x] - expected);
            if (!(error <= worst)) worst = error;
        }
    free(slow);
    return worst;
}

TEST(noise_agrees_with_the_slow_twin) {
    const double noises[] = {0.5, 0.1, 0.001};
    for (int i = 0; i < 3; i++) {
        Arena arena = *test_memory();
        const Canvas r = canvas_scene(24, 18, noises[i], 1, &arena);
        const Canvas t = canvas_scene(24, 18, noises[i], 2, &arena);
        assert_near(worst_against_slow(&r, &t, FLIP_PIXELS_PER_DEGREE, arena), 0, 5e-6);
    }
}

ARENA_TEST(other_screens_agree_with_the_slow_twin) {
    const Canvas r = canvas_scene(14, 11, 0.2, 1, &arena);
    const Canvas t = canvas_scene(14, 11, 0.2, 2, &arena);
    assert_near(worst_against_slow(&r, &t, 10, arena), 0, 5e-6);
    assert_near(worst_against_slow(&r, &t, 40, arena), 0, 5e-6);
    assert_near(worst_against_slow(&r, &t, 120, arena), 0, 5e-6);
}

/* Lighter everywhere by the same: edges that did not change must not show as changed. (Their
 * difference goes through a square root, which makes 1e-4 of a float's 1e-8.) */
ARENA_TEST(unchanged_edges_agree_with_the_slow_twin) {
    const Canvas noisy = canvas_scene(24, 18, 0.1, 1, &arena);
    const Canvas r = canvas_scaled(&noisy, 0.5, &arena), t = canvas_scaled(&r, 1, &arena);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 24 * 18; i++) t.rgb[c][i] += 0.25f;
    assert_near(worst_against_slow(&r, &t, FLIP_PIXELS_PER_DEGREE, arena), 0, 5e-6);
}

/* The borders of tiles lie at 128: pixels about them. */
ARENA_TEST(tiles_have_no_seams) {
    const Canvas r = canvas_scene(140, 135, 0.2, 1, &arena);
    const Canvas t = canvas_scene(140, 135, 0.2, 2, &arena);
    const float *map = ldr_map(&r, &t, &arena);
    SlowFlip *slow = slow_flip_create(FLIP_PIXELS_PER_DEGREE);
    for (int i = 120; i < 135; i++) {
        double across = slow_flip_pixel(slow, &r.planes, &t.planes, i, 64);
        double down = slow_flip_pixel(slow, &r.planes, &t.planes, 64, i);
        double slanting = slow_flip_pixel(slow, &r.planes, &t.planes, i, i);
        assert_near(map[64 * 140 + i], across, 5e-6);
        assert_near(map[i * 140 + 64], down, 5e-6);
        assert_near(map[i * 140 + i], slanting, 5e-6);
    }
    free(slow);
}

ARENA_TEST(threads_change_no_bit) {
    const Canvas r = canvas_scene(260, 140, 0.2, 1, &arena);
    const Canvas t = canvas_scene(260, 140, 0.2, 2, &arena);
    const size_t bytes = planes_pixel_count(&r.planes) * sizeof(float);
    FlipOptions options = DEFAULTS;
    float *one = new_map(&r.planes, &arena), *many = new_map(&r.planes, &arena);
    flip_ldr(&r.planes, &t.planes, &options, arena, one);
    for (int threads = 2; threads <= 16; threads *= 2) {
        options.threads = threads;
        flip_ldr(&r.planes, &t.planes, &options, arena, many);
        assert_memory_equal(one, many, bytes);
    }
}

ARENA_TEST(reference_and_test_may_change_places) {
    const Canvas r = canvas_scene(40, 30, 0.4, 1, &arena);
    const Canvas t = canvas_scene(40, 30, 0.4, 2, &arena);
    assert_memory_equal(ldr_map(&r, &t, &arena), ldr_map(&t, &r, &arena),
                        planes_pixel_count(&r.planes) * sizeof(float));
}

static Canvas transposed(const Canvas *source, Arena *arena) {
    const int w = source->planes.width, h = source->planes.height;
    Canvas out = canvas_create(h, w, arena);
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) out.rgb[c][x * h + y] = source->rgb[c][y * w + x];
    return out;
}

ARENA_TEST(rows_and_columns_may_change_places) {
    const Canvas r = canvas_scene(40, 25, 0.2, 1, &arena);
    const Canvas t = canvas_scene(40, 25, 0.2, 2, &arena);
    const Canvas rt = transposed(&r, &arena), tt = transposed(&t, &arena);
    const float *map = ldr_map(&r, &t, &arena), *turned = ldr_map(&rt, &tt, &arena);
    for (int y = 0; y < 25; y++)
        for (int x = 0; x < 40; x++) assert_near(map[y * 40 + x], turned[x * 25 + y], 1e-6);
}

ARENA_TEST(more_difference_gives_more) {
    const Canvas grey = canvas_uniform(0.2f, 0.2f, 0.2f, &arena);
    const Canvas clean = canvas_scene(60, 50, 0, 1, &arena);
    double last_step = 0, last_noise = 0;
    for (int i = 1; i <= 12; i++) {
        float level = 0.2f + 0.06f * (float)i;
        const Canvas other = canvas_uniform(level, level, level, &arena);
        const Canvas noisy = canvas_scene(60, 50, 0.04 * i, 7, &arena);
        double step = mean_of(&grey, &other, arena), noise = mean_of(&clean, &noisy, arena);
        assert_true(step > last_step && step <= 1);
        assert_true(noise > last_noise && noise <= 1);
        last_step = step;
        last_noise = noise;
    }
}

/* Colours of a cube's corners, at random: the most that a picture can do. */
ARENA_TEST(nothing_leaves_0_to_1) {
    uint64_t seed = 5;
    Canvas pictures[2];
    for (int p = 0; p < 2; p++) {
        pictures[p] = canvas_create(90, 70, &arena);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < 90 * 70; i++)
                pictures[p].rgb[c][i] = fixture_random(&seed) < 0.5 ? 0 : 1;
    }
    const float *map = ldr_map(&pictures[0], &pictures[1], &arena);
    const MapSummary all = map_summary(map, 90 * 70, NULL);
    for (int i = 0; i < 90 * 70; i++) assert_true(map[i] >= 0 && map[i] <= 1);
    assert_true(all.max > 0.5 && all.median < all.p95 && all.p95 < all.max);
}

ARENA_TEST(one_pixel_is_a_picture) {
    const Canvas a = canvas_create(1, 1, &arena), b = canvas_create(1, 1, &arena);
    canvas_fill(&a, 0, 1, 0);
    canvas_fill(&b, 0, 0, 1);
    assert_near(mean_of(&a, &b, arena), 1, 1e-6);
}

static double sum_of_filter(const FlipFilter *f) {
    double sum = f->weights[0];
    for (int k = 1; k <= f->radius; k++) sum += 2 * f->weights[k];
    return sum;
}

ARENA_TEST(filters_keep_their_sums) {
    const double screens[] = {1, 4, 30, FLIP_PIXELS_PER_DEGREE, 300};
    for (int i = 0; i < 5; i++) {
        const FlipFilters f = flip_filters_create(screens[i], &arena);
        double slope = 0, b0 = sum_of_filter(&f.blue_yellow[0]);
        double b1 = sum_of_filter(&f.blue_yellow[1]);
        for (int k = 1; k <= f.slope.radius; k++) slope += f.slope.weights[k];
        assert_near(sum_of_filter(&f.lightness), 1, 1e-14);
        assert_near(sum_of_filter(&f.red_green), 1, 1e-14);
        assert_near(sum_of_filter(&f.gauss), 1, 1e-14);
        assert_near(b0 * b0 + b1 * b1, 1, 1e-14);
        assert_near(slope, f.slope.radius ? 1 : 0, 1e-14);
        assert_near(sum_of_filter(&f.curve), f.slope.radius ? 0 : -1, 1e-14);
    }
    assert_int_equal(flip_filters_create(FLIP_PIXELS_PER_DEGREE, &arena).radius, 10);
    assert_int_equal(flip_filters_create(FLIP_PIXELS_PER_DEGREE, &arena).gauss.radius, 9);
}

TEST(a_summary_keeps_to_its_mask) {
    float map[100];
    unsigned char mask[100];
    for (int i = 0; i < 100; i++) {
        map[i] = (float)((i * 37) % 100) / 100; /* every hundredth once */
        mask[i] = map[i] < 0.5f;
    }
    const MapSummary all = map_summary(map, 100, NULL), half = map_summary(map, 100, mask);
    assert_near(all.mean, 0.495, 1e-7);
    assert_near(all.median, 0.49, 1e-7);
    assert_near(all.p95, 0.94, 1e-7);
    assert_near(all.max, 0.99, 1e-7);
    assert_near(half.mean, 0.245, 1e-7);
    assert_near(half.median, 0.24, 1e-7);
    assert_near(half.max, 0.49, 1e-7);
    memset(mask, 0, sizeof mask);
    const MapSummary none = map_summary(map, 100, mask);
    assert_true(isnan(none.mean) && isnan(none.median) && isnan(none.p95) && isnan(none.max));
}

/* ---- HDR ---- */

static double slow_tone(double x) {
    return fmin((0.9036 * x * x + 0.018 * x) / (0.8748 * x * x + 0.354 * x + 0.14), 1);
}

ARENA_TEST(even_light_follows_the_closed_form) {
    const Canvas r = canvas_uniform(40, 40, 40, &arena);
    const Canvas t = canvas_uniform(90, 90, 90, &arena);
    const FlipOptions options = {
        .threads = 1, .has_range = true, .start_ev = -9, .stop_ev = -2, .exposures = 8};
    float *map = new_map(&r.planes, &arena);
    FlipExposures used = flip_hdr(&r.planes, &t.planes, &options, arena, map);
    double most = 0;
    int deciding = 0;
    for (int i = 0; i < 8; i++) {
        double a = slow_tone(40 * exp2(i - 9)), b = slow_tone(90 * exp2(i - 9));
        double flip = slow_colour_difference((double[3]){a, a, a}, (double[3]){b, b, b});
        if (flip <= most) continue;
        most = flip;
        deciding = i;
    }
    assert_all_near(map, planes_pixel_count(&r.planes), most, 2e-6);
    assert_true(deciding > 0 && deciding < 7);
    assert_int_equal(used.count, 8);
    assert_near(used.start_ev, -9, 0);
    assert_near(used.stop_ev, -2, 0);
}

static Canvas tone_mapped(const Canvas *source, double ev, Arena *arena) {
    Canvas out = canvas_scaled(source, exp2(ev), arena);
    for (size_t i = 0; i < planes_pixel_count(&out.planes); i++)
        for (int c = 0; c < 3; c++) out.rgb[c][i] = (float)slow_tone((double)out.rgb[c][i]);
    return out;
}

/* Not to the last bit: here the tone-mapped pictures are rounded to floats. */
ARENA_TEST(one_exposure_is_the_tone_mapped_picture) {
    const Canvas r0 = canvas_scene(50, 40, 0.2, 1, &arena);
    const Canvas r = canvas_scaled(&r0, 300, &arena);
    const Canvas t0 = canvas_scene(50, 40, 0.2, 2, &arena);
    const Canvas t = canvas_scaled(&t0, 300, &arena);
    const Canvas rm = tone_mapped(&r, -8.5, &arena), tm = tone_mapped(&t, -8.5, &arena);
    const FlipOptions options = {
        .threads = 1, .has_range = true, .start_ev = -8.5, .stop_ev = -8.5};
    float *hdr = new_map(&r.planes, &arena), *ldr = ldr_map(&rm, &tm, &arena);
    FlipExposures used = flip_hdr(&r.planes, &t.planes, &options, arena, hdr);
    assert_int_equal(used.count, 1);
    for (int i = 0; i < 50 * 40; i++) assert_near(hdr[i], ldr[i], 1e-5);
}

/* Three exposures against each for itself. */
ARENA_TEST(the_greatest_exposure_counts) {
    const Canvas r = canvas_scene(150, 40, 0.2, 1, &arena);
    const Canvas t = canvas_scene(150, 40, 0.2, 2, &arena);
    const size_t count = planes_pixel_count(&r.planes);
    FlipOptions options = {
        .threads = 1, .has_range = true, .start_ev = -3, .stop_ev = 3, .exposures = 3};
    float *all = new_map(&r.planes, &arena), *one[3];
    int decided[3] = {0};
    flip_hdr(&r.planes, &t.planes, &options, arena, all);
    options.exposures = 1;
    for (int e = 0; e < 3; e++) {
        options.start_ev = options.stop_ev = 3 * e - 3;
        one[e] = new_map(&r.planes, &arena);
        flip_hdr(&r.planes, &t.planes, &options, arena, one[e]);
    }
    for (size_t i = 0; i < count; i++) {
        assert_near(all[i], fmaxf(fmaxf(one[0][i], one[1][i]), one[2][i]), 0);
        for (int e = 0; e < 3; e++) decided[e] += all[i] == one[e][i];
    }
    assert_true(decided[0] && decided[1] && decided[2]);
}

/* 100 pixels: 1 of 800, 49 of 100 and 50 of 2 cd/m2: of the two in the middle the greater is
 * the median. */
static Canvas known_luminances(Arena *arena) {
    Canvas canvas = canvas_create(10, 10, arena);
    for (int i = 0; i < 100; i++)
        for (int c = 0; c < 3; c++) canvas.rgb[c][i] = i == 31 ? 800 : i < 50 ? 100 : 2;
    return canvas;
}

static FlipExposures range_of(const Canvas *reference, Arena arena) {
    float *map = new_map(&reference->planes, &arena);
    return flip_hdr(&reference->planes, &reference->planes, &DEFAULTS, arena, map);
}

ARENA_TEST(the_range_shows_the_brightest_and_the_median) {
    const Canvas r = known_luminances(&arena);
    FlipExposures used = range_of(&r, arena);
    assert_near(slow_tone(800 * exp2(used.start_ev)), 0.85, 1e-6);
    assert_near(slow_tone(100 * exp2(used.stop_ev)), 0.85, 1e-6);
    assert_near(used.stop_ev - used.start_ev, 3, 1e-6);
    assert_in_range(used.count, 3, 4); /* ceil of 3 and a rounding */
}

ARENA_TEST(an_even_reference_has_one_exposure) {
    const Canvas r = canvas_uniform(7, 7, 7, &arena);
    FlipExposures used = range_of(&r, arena);
    assert_int_equal(used.count, 1);
    assert_near(slow_tone(7 * exp2(used.start_ev)), 0.85, 1e-6);
}

/* The authors' median would be 0 here, and their range endless. */
ARENA_TEST(black_halves_leave_the_median_of_the_rest) {
    Canvas r = known_luminances(&arena);
    for (int c = 0; c < 3; c++)
        for (int i = 40; i < 100; i++) r.rgb[c][i] = 0;
    FlipExposures used = range_of(&r, arena);
    assert_near(used.stop_ev - used.start_ev, 3, 1e-6);
}

ARENA_TEST(a_black_reference_has_a_range) {
    const Canvas black = canvas_uniform(0, 0, 0, &arena);
    const Canvas grey = canvas_uniform(0.3f, 0.3f, 0.3f, &arena);
    float *map = new_map(&black.planes, &arena);
    FlipExposures used = flip_hdr(&black.planes, &grey.planes, &DEFAULTS, arena, map);
    double a = slow_tone((double)0.3f * 2);
    double expected = slow_colour_difference((double[3]){0}, (double[3]){a, a, a});
    assert_near(used.start_ev, 0, 0);
    assert_near(used.stop_ev, 1, 0);
    assert_int_equal(used.count, 2);
    assert_all_near(map, planes_pixel_count(&black.planes), expected, 2e-6);
}

ARENA_TEST(negative_light_is_black) {
    const Canvas a = canvas_uniform(5, 0, 5, &arena), b = canvas_uniform(5, -9, 5, &arena);
    float *map = new_map(&a.planes, &arena);
    FlipExposures of_a = flip_hdr(&a.planes, &b.planes, &DEFAULTS, arena, map);
    assert_all_near(map, planes_pixel_count(&a.planes), 0, 0);
    assert_near(range_of(&b, arena).start_ev, of_a.start_ev, 0);
}

/* The range goes with the reference, so the unit of light does not matter. */
ARENA_TEST(the_unit_of_light_does_not_matter) {
    const Canvas r = canvas_scene(40, 30, 0.2, 1, &arena);
    const Canvas t = canvas_scene(40, 30, 0.2, 2, &arena);
    const Canvas r8 = canvas_scaled(&r, 4096, &arena), t8 = canvas_scaled(&t, 4096, &arena);
    float *small = new_map(&r.planes, &arena), *large = new_map(&r.planes, &arena);
    FlipExposures a = flip_hdr(&r.planes, &t.planes, &DEFAULTS, arena, small);
    FlipExposures b = flip_hdr(&r8.planes, &t8.planes, &DEFAULTS, arena, large);
    assert_near(a.start_ev - b.start_ev, 12, 1e-9);
    assert_int_equal(a.count, b.count);
    for (int i = 0; i < 40 * 30; i++) assert_near(small[i], large[i], 1e-6);
    assert_true(map_summary(small, 40 * 30, NULL).mean > 0.05);
}

/* Light as strong as a float can hold must not become NaN in a tone curve. */
ARENA_TEST(the_strongest_light_is_white) {
    const Canvas r = canvas_uniform(1, 1, 1, &arena);
    const Canvas t = canvas_uniform(3e38f, 3e38f, 3e38f, &arena);
    float *map = new_map(&r.planes, &arena);
    double a = 0.85, white[3] = {1, 1, 1};
    flip_hdr(&r.planes, &t.planes, &DEFAULTS, arena, map);
    assert_all_near(map, planes_pixel_count(&r.planes),
                    slow_colour_difference((double[3]){a, a, a}, white), 2e-6);
}

TEST_PROGRAM(make_arena, drop_arena)
