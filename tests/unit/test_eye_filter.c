/* SPDX-License-Identifier: Apache-2.0 */
/* A picture's light spread as an eye spreads it: beside the sum over all pairs of pixels. */
#include "fixture.h"

#include "base/units.h"
#include "vision/eye_filter.h"

typedef struct Planes {
    float *rgb[3];
} Planes;

static Planes make_planes(const EyeView *view, float value, Arena *arena) {
    Planes planes;
    for (int c = 0; c < 3; c++) {
        planes.rgb[c] = ARENA_NEW(arena, float, view->width * view->height);
        for (int i = 0; i < view->width * view->height; i++) planes.rgb[c][i] = value;
    }
    return planes;
}

static EyeLayer layer_of(Planes in, Planes out) {
    EyeLayer layer;
    for (int c = 0; c < 3; c++) {
        layer.rgb[c] = in.rgb[c];
        layer.out[c] = out.rgb[c];
    }
    return layer;
}

static Planes filtered(const EyeFilter *filter, Planes in, Arena *arena) {
    Planes out = make_planes(&filter->view, -1, arena);
    EyeLayer layer = layer_of(in, out);
    assert_done(eye_filter(filter, &layer, 1, *arena, &err));
    return out;
}

/* The whole of a view that is `high` degrees high. */
static EyeView whole_view(int width, int height, double high) {
    double pixel = 2 * tan(radians_from_degrees(high) / 2) / height;
    return (EyeView){width, height, width / 2.0, height / 2.0, pixel};
}

static double solid_angle(const EyeView *view, int x, int y) {
    double a = (x + 0.5 - view->axis_x) * view->pixel;
    double b = (y + 0.5 - view->axis_y) * view->pixel;
    return view->pixel * view->pixel / pow(1 + a * a + b * b, 1.5);
}

/* CIE 135/1-1999, total glare, written out again. */
static double published(double t, HumanEye eye) {
    double a = pow(eye.age_years / 70, 4), p = eye.pigment, tenth = 1 + t * t / 0.01;
    return (1 - 0.08 * a) * (9.2e6 * pow(1 + pow(t / 0.0046, 2), -1.5) +
                             1.5e5 * pow(1 + pow(t / 0.045, 2), -1.5)) +
           (1 + 1.6 * a) *
               (400 / tenth + 3e-8 * t * t + p * (1300 * pow(tenth, -1.5) + 0.8 / sqrt(tenth))) +
           0.0025 * p;
}

/* Mean of the published spread over pixel (x, y) from the middle of pixel (sx, sy). */
static double true_spread(const EyeFilter *filter, int sx, int sy, int x, int y) {
    const EyeView *v = &filter->view;
    const int n = abs(x - sx) < 4 && abs(y - sy) < 4 ? 24 : 4;
    double sum = 0;
    double from[3] = {(sx + 0.5 - v->axis_x) * v->pixel, (sy + 0.5 - v->axis_y) * v->pixel, 1};
    for (int i = 0; i < n * n; i++) {
        double to[3] = {(x + (i % n + 0.5) / n - v->axis_x) * v->pixel,
                        (y + (i / n + 0.5) / n - v->axis_y) * v->pixel, 1};
        double dot = from[0] * to[0] + from[1] * to[1] + 1;
        double cx = from[1] - to[1], cy = to[0] - from[0];
        double cz = from[0] * to[1] - from[1] * to[0];
        double angle = degrees_from_radians(atan2(sqrt(cx * cx + cy * cy + cz * cz), dot));
        sum += published(fmin(angle, 90), filter->eye);
    }
    return sum / (n * n);
}

/* One bright pixel: every other shows f w L, and the light is all there. */
static void check_point(const EyeFilter *filter, int sx, int sy, double bound, Arena arena) {
    const EyeView *v = &filter->view;
    const float bright = 1e7f;
    double leak = 0; /* into the other channels: rounding */
    Planes in = make_planes(v, 0, &arena);
    in.rgb[1][sy * v->width + sx] = bright;
    Planes out = filtered(filter, in, &arena);
    double total = 0, lux = (double)bright * solid_angle(v, sx, sy), worst = 0;
    for (int y = 0; y < v->height; y++) {
        for (int x = 0; x < v->width; x++) {
            double found = (double)out.rgb[1][y * v->width + x];
            total += found * solid_angle(v, x, y);
            if (x == sx && y == sy) continue;
            double expected = lux * true_spread(filter, sx, sy, x, y);
            double error = fabs(found / expected - 1);
            if (!(error <= worst)) worst = error;
        }
    }
    for (int i = 0; i < v->width * v->height; i++)
        leak = fmax(leak, fmax(fabs((double)out.rgb[0][i]), fabs((double)out.rgb[2][i])));
    print_message("%d x %d, light at %d, %d: within %.2g, total %.6f, leak %.2g\n", v->width,
                  v->height, sx, sy, worst, total / lux, leak / lux);
    assert_true(worst <= bound);
    assert_close(total, lux, 1e-3);
    assert_true(leak < 1e-6 * 0.002 * lux); /* of the faintest veil, that at 90 degrees */
}

ARENA_TEST(a_light_spreads_as_in_the_eye) {
    const EyeFilter narrow = {whole_view(64, 36, 10), {30, 0.5}, 2};
    const EyeFilter usual = {whole_view(96, 54, 40), {60, 1.2}, 2};
    const EyeFilter wide = {whole_view(64, 36, 59), {25, 0}, 2};    /* 90 degrees across */
    const EyeFilter wider = {whole_view(64, 36, 90), {80, 1.2}, 2}; /* 121 */
    check_point(&narrow, 32, 18, 5e-3, arena);
    check_point(&narrow, 0, 3, 5e-3, arena);
    check_point(&usual, 50, 20, 5e-3, arena);
    check_point(&usual, 95, 53, 5e-3, arena);
    check_point(&wide, 30, 18, 5e-3, arena);
    check_point(&wide, 0, 0, 5e-3, arena);
    check_point(&wide, 60, 30, 5e-3, arena);
    check_point(&wider, 0, 0, 5e-3, arena);
    check_point(&wider, 33, 20, 5e-3, arena);
}

/* The veil is the published one, whatever its integral: by age and by the iris. */
ARENA_TEST(every_eye_has_its_published_veil) {
    static const double ages[] = {25, 60, 75}, pigments[] = {0, 0.5, 1, 1.2};
    for (int i = 0; i < 12; i++) {
        const EyeFilter filter = {whole_view(48, 27, 30), {ages[i / 4], pigments[i % 4]}, 2};
        check_point(&filter, 24, 13, 3e-3, arena);
        check_point(&filter, 3, 20, 3e-3, arena);
    }
}

/* A crop of a picture: the axis lies outside of it. */
ARENA_TEST(a_crop_keeps_its_angles) {
    EyeView crop = whole_view(96, 54, 40);
    crop.width = 30;
    crop.height = 20;
    crop.axis_x -= 60;
    crop.axis_y -= 30;
    const EyeFilter filter = {crop, {40, 0.5}, 1};
    check_point(&filter, 15, 10, 5e-3, arena);
    check_point(&filter, 29, 0, 5e-3, arena);
}

ARENA_TEST(one_row_and_one_pixel_are_pictures) {
    const EyeFilter row = {whole_view(40, 1, 0.5), {40, 0.5}, 1};
    const EyeFilter one = {whole_view(1, 1, 20), {40, 0.5}, 1};
    check_point(&row, 7, 0, 5e-3, arena);
    check_point(&one, 0, 0, 5e-3, arena);
}

/* Up to the border: what leaves the picture is kept where it came from. */
ARENA_TEST(an_even_picture_stays_even) {
    const EyeFilter filter = {whole_view(60, 40, 50), {70, 0.5}, 2};
    Planes out = filtered(&filter, make_planes(&filter.view, 321, &arena), &arena);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 60 * 40; i++) assert_close(out.rgb[c][i], 321, 1e-6);
}

ARENA_TEST(light_adds_up) {
    const EyeFilter filter = {whole_view(48, 32, 30), {50, 0.5}, 1};
    Planes one = make_planes(&filter.view, 2, &arena);
    Planes other = make_planes(&filter.view, 0, &arena);
    Planes both = make_planes(&filter.view, 2, &arena);
    double before = 0, after = 0;
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 48 * 32; i += 7) {
            other.rgb[c][i] = (float)((i * 37 + c * 11) % 101) * 50;
            both.rgb[c][i] = one.rgb[c][i] + other.rgb[c][i];
        }
    }
    Planes a = filtered(&filter, one, &arena), b = filtered(&filter, other, &arena);
    Planes sum = filtered(&filter, both, &arena);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 48 * 32; i++) {
            assert_close(sum.rgb[c][i], (double)a.rgb[c][i] + (double)b.rgb[c][i], 1e-6);
            before += (double)both.rgb[c][i] * solid_angle(&filter.view, i % 48, i / 48);
            after += (double)sum.rgb[c][i] * solid_angle(&filter.view, i % 48, i / 48);
        }
    }
    assert_close(after, before, 1e-4);
}

ARENA_TEST(what_is_not_finite_stays_and_spreads_nothing) {
    const EyeFilter filter = {whole_view(24, 16, 30), {50, 0.5}, 1};
    Planes in = make_planes(&filter.view, 10, &arena);
    in.rgb[0][5 * 24 + 6] = INFINITY;
    in.rgb[2][9 * 24 + 20] = NAN;
    Planes out = filtered(&filter, in, &arena);
    for (int i = 0; i < 24 * 16; i++) {
        for (int c = 0; c < 3; c++) {
            if (isnan(in.rgb[c][i])) assert_true(isnan(out.rgb[c][i]));
            else if (isinf(in.rgb[c][i])) assert_true(isinf(out.rgb[c][i]));
            else assert_close(out.rgb[c][i], 10, 1e-6);
        }
    }
}

/* Of one view, whose kernels are made once; a hole in one is a hole in both. */
ARENA_TEST(layers_spread_together_as_they_do_alone) {
    const EyeFilter filter = {whole_view(48, 30, 40), {50, 0.5}, 2};
    Planes in[2], alone[2], together[2];
    for (int k = 0; k < 2; k++) {
        in[k] = make_planes(&filter.view, 3, &arena);
        for (int i = 0; i < 48 * 30; i++)
            for (int c = 0; c < 3; c++)
                in[k].rgb[c][i] += (float)((i * (31 + 6 * k) + c * 13) % 97) * 20;
        in[k].rgb[k][77] = NAN;
        in[k].rgb[1][900] = INFINITY;
        together[k] = make_planes(&filter.view, -1, &arena);
    }
    in[0].rgb[1][77] = NAN; /* where the other one has it */
    in[1].rgb[0][77] = NAN;
    const EyeLayer layers[2] = {layer_of(in[0], together[0]), layer_of(in[1], together[1])};
    assert_done(eye_filter(&filter, layers, 2, arena, &err));
    for (int k = 0; k < 2; k++) {
        alone[k] = filtered(&filter, in[k], &arena);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < 48 * 30; i++)
                if (i != 77 && i != 900)
                    assert_close(together[k].rgb[c][i], alone[k].rgb[c][i], 1e-6);
    }
    assert_true(isinf(together[0].rgb[1][900]) && isnan(together[1].rgb[1][77]));
    assert_close(together[0].rgb[2][77], in[0].rgb[2][77], 0);
}

ARENA_TEST(threads_change_no_bit) {
    EyeFilter filter = {whole_view(40, 24, 35), {50, 0.5}, 1};
    Planes in = make_planes(&filter.view, 1, &arena);
    for (int i = 0; i < 40 * 24; i++) in.rgb[i % 3][i] = (float)(i % 17) * 3;
    Planes alone = filtered(&filter, in, &arena);
    filter.threads = 7;
    Planes together = filtered(&filter, in, &arena);
    for (int c = 0; c < 3; c++)
        assert_memory_equal(alone.rgb[c], together.rgb[c], 40 * 24 * sizeof(float));
}

TEST_PROGRAM(make_arena, drop_arena)
