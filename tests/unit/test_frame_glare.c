/* SPDX-License-Identifier: Apache-2.0 */
#include "frame_fixture.h"

#include "base/sampler.h"
#include "vision/frame/frame_glare.h"

#define PI 3.14159265358979323846

/* A disc of one luminance in an even field, by azimuth and elevation from the line of sight. */
typedef struct Disc {
    double right_deg, up_deg, width_deg, cd_m2;
} Disc;

static void towards(const Disc *disc, double out[3]) {
    double a = disc->right_deg * PI / 180, e = disc->up_deg * PI / 180;
    out[0] = cos(e) * sin(a);
    out[1] = sin(e);
    out[2] = cos(e) * cos(a);
}

/* Of a place of the fisheye: right and up in its radii. */
static double field(const Disc *discs, int count, double even, double u, double v) {
    double r = hypot(u, v), a = r * PI / 2, s = r > 0 ? sin(a) / r : 0;
    for (int i = 0; i < count; i++) {
        double d[3];
        towards(&discs[i], d);
        double cosine = s * u * d[0] + s * v * d[1] + cos(a) * d[2];
        if (cosine > cos(discs[i].width_deg * PI / 360)) return discs[i].cd_m2;
    }
    return even;
}

/* The mean over a pixel that shows a disc's edge. */
static double pixel_of(int size, int grid, const Disc *discs, int count, double even, int i) {
    double sum = 0;
    for (int k = 0; k < grid * grid; k++) {
        double x = i % size + (k % grid + 0.5) / grid, y = i / size + (k / grid + 0.5) / grid;
        sum += field(discs, count, even, 2 * x / size - 1, 1 - 2 * y / size);
    }
    return sum / (grid * grid);
}

static bool is_even(int size, const Disc *discs, int count, double even, int i) {
    double first =
        field(discs, count, even, 2.0 * (i % size) / size - 1, 1 - 2.0 * (i / size) / size);
    for (int k = 1; k < 9; k++) {
        double x = i % size + k % 3 / 2.0, y = i / size + k / 3 / 2.0;
        if (field(discs, count, even, 2 * x / size - 1, 1 - 2 * y / size) != first) return false;
    }
    return true;
}

/* grid: samples across a pixel; 1: edges are sharp. */
static FrameImage picture(int size, int grid, const Disc *discs, int count, double even,
                          Arena *arena) {
    FrameImage frame = uniform_frame(size, size, 0, arena);
    const float *rgb[3];
    frame_rgb(&frame, "", rgb);
    frame_set_fisheye(&frame, FISHEYE_EQUIDISTANT, arena);
    for (int i = 0; i < size * size; i++) {
        int own = grid > 1 && is_even(size, discs, count, even, i) ? 1 : grid;
        double value = pixel_of(size, own, discs, count, even, i);
        bool is_seen = hypot(fmax(fabs(i % size + 0.5 - size / 2.0) - 0.5, 0),
                             fmax(fabs(i / size + 0.5 - size / 2.0) - 0.5, 0)) < size / 2.0;
        for (int c = 0; c < 3; c++) ((float *)rgb[c])[i] = is_seen ? (float)value : 0;
    }
    return frame;
}

static const GlareRequest DEFAULT = {.settings = GLARE_SETTINGS_DEFAULT};

static FrameGlare glare_of(const FrameImage *frame, const GlareRequest *request, Arena *arena) {
    FrameGlare out;
    Error err;
    if (!frame_glare_measure(frame, request, arena, &out, &err)) fail_msg("%s", err.text);
    return out;
}

/* ---- closed forms ----------------------------------------------------------------------- */

/* The figures of discs: solid angle 2 pi (1 - cos), light pi sin^2 times the cosine. */
static void closed_form(const Disc *discs, int count, double even, double out[3]) {
    double lux = PI * even, direct = 0, squares = 0;
    for (int i = 0; i < count; i++) {
        double half = discs[i].width_deg * PI / 360, d[3];
        towards(&discs[i], d);
        double sr = 2 * PI * (1 - cos(half)), seen = PI * sin(half) * sin(half) * d[2];
        double p = position_index(d[0], d[1], d[2]);
        direct += discs[i].cd_m2 * seen;
        lux += (discs[i].cd_m2 - even) * seen;
        squares += discs[i].cd_m2 * discs[i].cd_m2 * sr / (p * p);
    }
    double factor = lux < 1000 ? 1 / (1 + exp(4 - 0.024 * lux)) : 1;
    out[0] = lux;
    out[1] = 8 * log10(0.25 * PI / (lux - direct) * squares);
    out[2] = factor * (5.87e-5 * lux + 0.092 * log10(1 + squares / pow(lux, 1.87)) + 0.159);
}

MEMORY_TEST(discs_in_an_even_field_have_their_closed_form) {
    static const struct {
        Disc disc[2];
        int count;
        double even;
    } CASES[] = {{{{0, 10, 5, 1e4}}, 1, 100},
                 {{{20, 15, 2, 1e5}}, 1, 100},
                 {{{-33, -12, 3, 3e4}}, 1, 20},
                 {{{5, 2, 2, 1e6}}, 1, 300},
                 {{{-20, 20, 3, 2e4}, {41, 7, 2.5, 5e4}}, 2, 60},
                 {{{70, 30, 5, 2e5}}, 1, 1000}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        Arena own = *arena;
        FrameImage frame = picture(360, 12, CASES[i].disc, CASES[i].count, CASES[i].even, &own);
        FrameGlare g = glare_of(&frame, &DEFAULT, &own);
        double wanted[3];
        closed_form(CASES[i].disc, CASES[i].count, CASES[i].even, wanted);
        assert_int_equal(g.source_count, CASES[i].count);
        assert_close(g.vertical_lx.value, wanted[0], 2e-3);
        assert_near(g.ugr.value, wanted[1], 0.3);
        assert_near(g.dgp.value, wanted[2], 0.005);
        assert_close(g.background_cd_m2.value, CASES[i].even, 0.02);
        assert_near(g.sources[0].right_deg,
                    CASES[i].disc[g.sources[0].right_deg > 10 && CASES[i].count > 1].right_deg,
                    0.3);
    }
}

MEMORY_TEST(an_even_field_has_its_light_and_no_source) {
    FrameImage frame = picture(200, 1, NULL, 0, 700, arena);
    FrameGlare g = glare_of(&frame, &DEFAULT, arena);
    assert_int_equal(g.source_count, 0);
    assert_int_equal(g.none, GLARE_NO_SOURCE);
    assert_close(g.vertical_lx.value, 700 * PI, 1e-6);
    assert_close(g.solid_angle_sr, 2 * PI, 1e-6);
    assert_true(isnan(g.ugr.value) && !isnan(g.dgp.value));
}

MEMORY_TEST(an_even_field_above_the_threshold_has_no_background) {
    FrameImage frame = picture(100, 1, NULL, 0, 2500, arena);
    FrameGlare g = glare_of(&frame, &DEFAULT, arena);
    assert_int_equal(g.none, GLARE_NO_BACKGROUND);
    assert_true(isnan(g.ugr.value));
    assert_close(g.vertical_lx.value, 2500 * PI, 1e-6);
}

/* ---- settings --------------------------------------------------------------------------- */

MEMORY_TEST(thresholds_decide_what_is_a_source) {
    static const Disc DISCS[] = {{0, 20, 6, 1500}, {30, 5, 6, 6000}};
    FrameImage frame = picture(300, 2, DISCS, 2, 40, arena);
    GlareRequest request = DEFAULT;
    assert_int_equal(glare_of(&frame, &request, arena).source_count, 1);
    request.settings.threshold_cd_m2 = 1000;
    assert_int_equal(glare_of(&frame, &request, arena).source_count, 2);
    request.settings.threshold_cd_m2 = 7000;
    assert_int_equal(glare_of(&frame, &request, arena).source_count, 0);
    request.settings.task_factor = 5; /* of 40 cd/m2 and the upper disc's edge about the gaze */
    request.settings.task_deg = 20;
    FrameGlare g = glare_of(&frame, &request, arena);
    assert_close(g.task_cd_m2, 40, 1e-5);
    assert_close(g.threshold_cd_m2, 200, 1e-5);
    assert_int_equal(g.source_count, 2);
}

MEMORY_TEST(a_peak_is_a_source_apart) {
    static const Disc DISCS[] = {{10, 10, 2, 2e5}, {10, 10, 20, 8000}};
    FrameImage frame = picture(400, 2, DISCS, 2, 100, arena);
    GlareRequest request = DEFAULT;
    FrameGlare g = glare_of(&frame, &request, arena);
    assert_int_equal(g.source_count, 2);
    assert_close(g.sources[0].source.luminance_cd_m2, 2e5, 1e-3);
    assert_close(g.sources[1].source.luminance_cd_m2, 8000, 1e-3);
    request.settings.peak_cd_m2 = 1e9;
    assert_int_equal(glare_of(&frame, &request, arena).source_count, 1);
}

MEMORY_TEST(the_low_light_factor_may_be_left_out) {
    static const Disc DISC = {0, 10, 5, 1e4};
    FrameImage frame = picture(300, 2, &DISC, 1, 10, arena);
    GlareRequest request = DEFAULT;
    FrameGlare with = glare_of(&frame, &request, arena);
    request.settings.low_light = false;
    FrameGlare without = glare_of(&frame, &request, arena);
    double lux = with.vertical_lx.value;
    assert_true(lux < 200);
    assert_close(with.dgp.value, without.dgp.value / (1 + exp(4 - 0.024 * lux)), 1e-9);
}

MEMORY_TEST(a_frame_that_sees_less_needs_the_illuminance) {
    FrameImage frame = uniform_frame(60, 40, 50, arena);
    GlareRequest request = DEFAULT;
    FrameGlare g;
    Error err;
    frame_set_number(&frame, "parhelion:yfov_deg", 40, arena);
    assert_false(frame_glare_measure(&frame, &request, arena, &g, &err));
    assert_non_null(strstr(err.text, "--vertical-lux"));
    request.has_lux = true;
    request.vertical_lx = 300;
    g = glare_of(&frame, &request, arena);
    assert_close(g.vertical_lx.value, 300, 1e-12);
    assert_close(g.background_cd_m2.value, 300 / PI, 1e-9);
    assert_true(isnan(g.vertical_lx.low));
}

/* ---- noise ------------------------------------------------------------------------------ */

/* A variable of the normal distribution. */
static double normal(uint32_t *state) {
    *state = hash_u32(*state + 1);
    double u = (*state + 0.5) * 0x1p-32;
    *state = hash_u32(*state + 1);
    return sqrt(-2 * log(u)) * cos(2 * PI * (*state + 0.5) * 0x1p-32);
}

/* Two halves of the samples, each off by `sigma` of the luminance: their mean is shown. */
static void add_noise(FrameImage *frame, double sigma, uint32_t seed, Arena *arena) {
    const float *rgb[3];
    float *halves[3], *variance[3];
    frame_rgb(frame, "", rgb);
    for (int c = 0; c < 3; c++) {
        halves[c] =
            frame_add_channel(frame, arena_format(arena, "halves.%c", "RGB"[c]), false, arena);
        variance[c] =
            frame_add_channel(frame, arena_format(arena, "variance.%c", "RGB"[c]), false, arena);
    }
    for (size_t i = 0; i < frame_pixel_count(frame); i++) {
        double y = (double)rgb[0][i], a = y * (1 + sigma * normal(&seed));
        double b = y * (1 + sigma * normal(&seed));
        for (int c = 0; c < 3; c++) {
            ((float *)rgb[c])[i] = (float)((a + b) / 2);
            halves[c][i] = (float)((a - b) / 2);
            variance[c][i] = (float)(sigma * y * sigma * y / 2);
        }
    }
}

/* A lone bright path, of one half of a pixel's samples. */
static void add_firefly(FrameImage *frame, size_t i, float cd_m2) {
    const float *rgb[3], *halves[3];
    frame_rgb(frame, "", rgb);
    frame_rgb(frame, "halves", halves);
    for (int c = 0; c < 3; c++) {
        ((float *)rgb[c])[i] += cd_m2;
        ((float *)halves[c])[i] += i % 2 ? cd_m2 : -cd_m2;
    }
}

MEMORY_TEST(noise_is_no_source) {
    for (uint32_t seed = 0; seed < 5; seed++) {
        Arena own = *arena;
        FrameImage frame = picture(200, 1, NULL, 0, 900, &own);
        add_noise(&frame, 0.7, seed, &own); /* a tenth of the pixels is above 2000 */
        for (size_t i = 0; i < 40; i++) add_firefly(&frame, 5000 + 777 * i, 60000);
        FrameGlare g = glare_of(&frame, &DEFAULT, &own);
        assert_int_equal(g.source_count, 0);
        assert_true(g.doubtful > 40);
        assert_true(isnan(g.ugr.value));
    }
}

MEMORY_TEST(noise_hides_no_source) {
    static const Disc DISC = {-15, 12, 4, 2e4};
    for (uint32_t seed = 0; seed < 5; seed++) {
        Arena own = *arena;
        FrameImage frame = picture(200, 2, &DISC, 1, 100, &own);
        add_noise(&frame, 0.3, seed, &own);
        FrameGlare g = glare_of(&frame, &DEFAULT, &own);
        assert_int_equal(g.source_count, 1);
        assert_true(g.has_intervals);
    }
}

/* 95 % of the intervals hold what the frame has without noise. Edges are sharp: which pixels
 * are sources is no matter of chance. */
MEMORY_TEST(intervals_hold) {
    static const Disc DISCS[] = {{-15, 12, 5, 3e4}, {30, 5, 6, 9e3}};
    FrameImage clean = picture(120, 1, DISCS, 2, 150, arena);
    FrameGlare truth = glare_of(&clean, &DEFAULT, arena);
    int held[5] = {0}, runs = 120;
    for (int run = 0; run < runs; run++) {
        Arena own = *arena;
        FrameImage frame = picture(120, 1, DISCS, 2, 150, &own);
        add_noise(&frame, 0.15, (uint32_t)run * 977, &own);
        FrameGlare g = glare_of(&frame, &DEFAULT, &own);
        const Measured figures[5] = {g.vertical_lx, g.background_cd_m2, g.ugr, g.dgp, g.dgi};
        const double wanted[5] = {truth.vertical_lx.value, truth.background_cd_m2.value,
                                  truth.ugr.value, truth.dgp.value, truth.dgi.value};
        for (int k = 0; k < 5; k++)
            held[k] += figures[k].low <= wanted[k] && wanted[k] <= figures[k].high;
    }
    for (int k = 0; k < 5; k++) {
        /* 95 % of 120 are 114, three standard deviations 7.2 */
        if (held[k] < 107) fail_msg("figure %d: %d of %d", k, held[k], runs);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
