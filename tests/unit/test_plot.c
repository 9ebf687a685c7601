/* SPDX-License-Identifier: Apache-2.0 */
/* The parts of a picture: ticks, curves, lines of equal value, colours, places, documents. */
#include "fixture.h"

#include "base/units.h"
#include "plot/draw/chart.h"
#include "plot/draw/picture.h"
#include "plot/draw/ticks.h"

/* The leak sanitizer needs this: the font library keeps what it has found until the end. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libfontconfig";
}

/* ---- ticks ------------------------------------------------------------------------------ */

TEST(ticks_are_round_inside_and_few) {
    for (int k = 0; k < 400; k++) {
        double low = -3 + 0.037 * k, high = low + pow(10, -4 + 0.02 * k);
        for (int most = 2; most <= 12; most++) {
            Ticks ticks = ticks_linear(low, high, most);
            double digit = ticks.step / pow(10, floor(log10(ticks.step) + 1e-9));
            assert_true(ticks.count <= most);
            assert_true(fabs(digit - 1) < 1e-6 || fabs(digit - 2) < 1e-6 ||
                        fabs(digit - 2.5) < 1e-6 || fabs(digit - 5) < 1e-6);
            for (int i = 0; i < ticks.count; i++) {
                double slack = 1e-8 * (high - low), n = ticks.value[i] / ticks.step;
                assert_true(ticks.value[i] >= low - slack && ticks.value[i] <= high + slack);
                assert_near(n, nearbyint(n), 1e-6);
            }
        }
    }
}

TEST(a_unit_range_has_fifths) {
    Ticks ticks = ticks_linear(0, 1, 6);
    char text[32];
    assert_int_equal(ticks.count, 6);
    assert_string_equal(tick_text(ticks.value[0], ticks.step, text), "0.0");
    assert_string_equal(tick_text(ticks.value[3], ticks.step, text), "0.6");
    assert_string_equal(tick_text(-30, 30, text), "−30");
    assert_string_equal(tick_text(0.025, 0.0025, text), "0.0250");
}

TEST(logarithmic_ticks_are_decades) {
    Ticks ticks = ticks_log(1e-4, 10, 8);
    int labelled = 0;
    for (int i = 0; i < ticks.count; i++) {
        double e = log10(ticks.value[i]);
        if (!ticks.is_labelled[i]) continue;
        labelled++;
        assert_near(e, nearbyint(e), 1e-9);
    }
    assert_int_equal(labelled, 6);
    ticks = ticks_log(100, 1000, 6); /* one decade: twos and fives too */
    labelled = 0;
    for (int i = 0; i < ticks.count; i++) labelled += ticks.is_labelled[i];
    assert_int_equal(labelled, 4);
    char text[32];
    assert_string_equal(tick_text(1e-4, 0, text), "10⁻⁴");
    assert_string_equal(tick_text(5e-4, 0, text), "5·10⁻⁴");
    assert_string_equal(tick_text(0.02, 0, text), "0.02");
    assert_string_equal(tick_text(1e6, 0, text), "10⁶");
}

TEST(figures_have_three_digits) {
    char text[32];
    assert_string_equal(figure_text(906.4, text), "906");
    assert_string_equal(figure_text(1298, text), "1298");
    assert_string_equal(figure_text(70.66, text), "70.7");
    assert_string_equal(figure_text(0.0203, text), "0.0203");
    assert_string_equal(figure_text(-1.5, text), "−1.50");
    assert_string_equal(figure_text(3.14e-6, text), "3.14·10⁻⁶");
    assert_string_equal(figure_text(0, text), "0");
}

TEST(round_numbers_enclose) {
    for (double v = 1e-5; v < 1e6; v *= 1.37) {
        assert_true(round_up(v) >= v * (1 - 1e-8) && round_up(v) <= 2.5 * v * (1 + 1e-8));
        assert_true(round_down(v) <= v * (1 + 1e-8) && round_down(v) >= v / 2.5 * (1 - 1e-8));
    }
}

/* ---- charts ------------------------------------------------------------------------------ */

#define SCALE 4 /* pixels per point */
#define SIZE 400

typedef struct Picture8 {
    cairo_surface_t *surface;
    Canvas canvas;
} Picture8;

static Picture8 picture_of(const Chart *chart) {
    Picture8 picture = {cairo_image_surface_create(CAIRO_FORMAT_RGB24, SIZE * SCALE, SIZE * SCALE),
                        {0}};
    picture.canvas = (Canvas){cairo_create(picture.surface), SCALE, test_memory()};
    cairo_scale(picture.canvas.cr, SCALE, SCALE);
    cairo_rectangle(picture.canvas.cr, 0, 0, SIZE, SIZE);
    canvas_fill(&picture.canvas, INK_PAPER);
    chart_draw(&picture.canvas, (Box){0, 0, SIZE, SIZE}, chart);
    cairo_surface_flush(picture.surface);
    assert_int_equal(cairo_status(picture.canvas.cr), CAIRO_STATUS_SUCCESS);
    return picture;
}

static void picture_end(Picture8 *picture) {
    cairo_destroy(picture->canvas.cr);
    cairo_surface_destroy(picture->surface);
}

/* red, green and blue at a point of the page, codes */
static const unsigned char *pixel_at(const Picture8 *picture, double x, double y) {
    static unsigned char rgb[3];
    int stride = cairo_image_surface_get_stride(picture->surface);
    const unsigned char *p = cairo_image_surface_get_data(picture->surface) +
                             (int)(y * SCALE) * stride + 4 * (int)(x * SCALE);
    for (int c = 0; c < 3; c++) rgb[c] = p[2 - c];
    return rgb;
}

static bool has_ink(const unsigned char rgb[3], Ink ink) {
    const double codes[] = {255 * ink.red, 255 * ink.green, 255 * ink.blue};
    for (int c = 0; c < 3; c++)
        if (fabs(rgb[c] - codes[c]) > 6) return false;
    return true;
}

/* Where ink stands: its mean place and how many pixels have it. */
static int ink_at(const Picture8 *picture, Ink ink, double mean[2]) {
    int count = 0;
    mean[0] = mean[1] = 0;
    for (int i = 0; i < SIZE * SCALE * SIZE * SCALE; i++) {
        double x = (i % (SIZE * SCALE) + 0.5) / SCALE, y = (i / (SIZE * SCALE) + 0.5) / SCALE;
        if (!has_ink(pixel_at(picture, x, y), ink)) continue;
        mean[0] += x;
        mean[1] += y;
        count++;
    }
    for (int k = 0; k < 2; k++) mean[k] /= count ? count : 1;
    return count;
}

/* The page's disc: of its middle and radius. */
static const double MIDDLE[] = {26 + 140, 200}, RADIUS = 140;

static double theta_of(const void *context, double theta, double phi) {
    (void)context;
    (void)phi;
    return theta;
}

static double towards_the_upper_right(const void *context, double theta, double phi) {
    (void)context;
    return sin(theta) * (cos(phi) + 0.5 * sin(phi));
}

static double above_the_middle(const void *context, double u, double v) {
    (void)context;
    return v < 0.5 ? 1 + u : 0;
}

TEST(rows_are_what_the_quantity_says) {
    Chart *chart = chart_new(CHART_POLAR, "t", NULL, "cd", test_memory());
    chart_fill(chart, towards_the_upper_right, NULL);
    assert_int_equal(chart->table->row_count, CHART_THETAS * CHART_PHIS);
    for (int row = 0; row < chart->table->row_count; row += 7)
        assert_near(chart_cell(chart, row, 2),
                    towards_the_upper_right(NULL, radians_from_degrees(chart_cell(chart, row, 0)),
                                            radians_from_degrees(chart_cell(chart, row, 1))),
                    1e-12);
    ChartRange range = chart_range(chart, 45);
    assert_near(range.high, sin(PI / 4) * sqrt(1.25), 1e-3);
    assert_near(chart_cell(chart, range.highest, 0), 45, 1e-9);
    assert_near(range.low, -range.high, 1e-3);
    assert_string_equal(chart->table->kind->columns[2].key, "t, cd");
}

/* Lines of equal theta are circles where that theta is. */
TEST(a_function_of_theta_has_circles) {
    Chart *chart = chart_new(CHART_POLAR, "t", NULL, "", test_memory());
    chart_fill(chart, theta_of, NULL);
    chart->y.high = 40; /* one dark colour everywhere */
    chart->strong = radians_from_degrees(50);
    Picture8 picture = picture_of(chart);
    for (int deg = 10; deg < 360; deg += 10) {
        double sum = 0, weighted = 0, phi = radians_from_degrees(deg);
        if (deg % 45 == 0 || (deg > 280 && deg < 310)) continue; /* spokes; the rings' degrees */
        for (double r = RADIUS * 5 / 9 - 3; r < RADIUS * 5 / 9 + 3; r += 0.05) {
            double l = pixel_at(&picture, MIDDLE[0] + r * cos(phi), MIDDLE[1] - r * sin(phi))[0];
            if (l < 60) continue;
            sum += l;
            weighted += l * r;
        }
        assert_true(sum > 0);
        assert_near(weighted / sum, RADIUS * 5 / 9, 0.3);
    }
    picture_end(&picture);
}

/* 0 degrees is right, 90 is up; the colour is the amount's. */
TEST(directions_stand_where_the_viewer_sees_them) {
    Chart *chart = chart_new(CHART_POLAR, "t", NULL, "", test_memory());
    chart_fill(chart, towards_the_upper_right, NULL);
    chart->y = (ChartAxis){.low = -1.2, .high = 1.2};
    chart->has_no_lines = true;
    Picture8 picture = picture_of(chart);
    for (int deg = 10; deg < 360; deg += 20) {
        double phi = radians_from_degrees(deg), theta = radians_from_degrees(50);
        double r = RADIUS * 50 / 90;
        double t = (towards_the_upper_right(NULL, theta, phi) + 1.2) / 2.4;
        if (deg % 45 == 0 || (deg > 280 && deg < 310)) continue;
        assert_true(has_ink(pixel_at(&picture, MIDDLE[0] + r * cos(phi), MIDDLE[1] - r * sin(phi)),
                            ink_of_amount(t)));
    }
    picture_end(&picture);
}

TEST(what_was_not_measured_is_dimmed_and_hatched) {
    Chart *chart = chart_new(CHART_POLAR, "t", NULL, "", test_memory());
    chart_fill(chart, theta_of, NULL);
    chart->y.high = 1000;
    chart->measured[1] = 50;
    Picture8 picture = picture_of(chart);
    int inside = pixel_at(&picture, MIDDLE[0] + 0.3 * RADIUS, MIDDLE[1] - 0.1 * RADIUS)[1];
    int low = 255, high = 0;
    for (double r = 0.92; r < 0.98; r += 0.001) {
        int l = pixel_at(&picture, MIDDLE[0] + r * RADIUS * cos(0.3),
                         MIDDLE[1] - r * RADIUS * sin(0.3))[1];
        low = l < low ? l : low;
        high = l > high ? l : high;
    }
    assert_true(low > inside + 25); /* dimmed with paper everywhere */
    assert_true(high > low + 10);   /* and hatched */
    picture_end(&picture);
}

/* Row 0 is on top, u runs to the right. */
TEST(an_area_stands_as_one_faces_it) {
    Chart *chart = chart_new(CHART_AREA, "t", NULL, "", test_memory());
    double mean[2];
    chart_fill(chart, above_the_middle, NULL);
    chart->y.high = 2;
    chart->ratio = 2;
    Picture8 picture = picture_of(chart); /* 326 points wide, 163 high */
    assert_true(has_ink(pixel_at(&picture, 50, 150), ink_of_amount(0)));
    assert_true(has_ink(pixel_at(&picture, 300, 40), ink_of_amount((1 + 300 / 326.0) / 2)));
    assert_true(ink_at(&picture, ink_of_amount(0), mean) > 100000);
    assert_near(mean[1], 24 + 163 * 0.75, 3);
    picture_end(&picture);
}

/* A curve's points and rings are where the axes have their values; what is not there interrupts
 * the curve. */
TEST(axes_put_values_where_they_belong) {
    Chart *chart = chart_new(CHART_AXES, "t", "x", "y", test_memory());
    Ink red = ink_of_primary(0), blue = ink_of_primary(2);
    double first[2], second[2], middle[2];
    chart->x = (ChartAxis){.low = -90, .high = 90};
    chart->y = (ChartAxis){.low = 0.01, .high = 100, .is_log = true};
    chart_series(chart, "a", (Stroke){red, 3, DASH_NONE});
    for (int x = -90; x <= 90; x++) chart_point(chart, x, x == 0 ? (double)NAN : 1);
    chart_series(chart, "b", (Stroke){blue, 3, DASH_NONE})->has_rings = true;
    chart_point(chart, 45, 10);
    chart_point(chart, 45, -1); /* no logarithm */
    assert_int_equal(chart->series[1].count, 2);
    Picture8 picture = picture_of(chart);
    assert_true(ink_at(&picture, red, first) > 2000);
    assert_true(ink_at(&picture, blue, second) > 100);
    int height = SIZE - 22 - 34;
    assert_near(first[1], 22 + height * 0.5, 0.5);   /* 1 is the middle of 0.01 to 100 */
    assert_near(second[1], 22 + height * 0.25, 0.5); /* 10 is three quarters up */
    assert_near(second[0] - first[0], 0.25 * 2 * (SIZE - 14 - first[0]), 1);
    assert_false(has_ink(pixel_at(&picture, first[0], first[1]), red)); /* the gap */
    assert_true(ink_at(&picture, INK_FAINT, middle) > 100);
    picture_end(&picture);
}

TEST(data_without_spread_have_a_picture) {
    for (int pass = 0; pass < 6; pass++) {
        Chart *chart =
            chart_new((ChartKind)(pass % 3), "t", pass % 3 ? NULL : "x", "y", test_memory());
        if (pass % 3) chart_fill(chart, theta_of, NULL);
        chart->x.is_log = chart->y.is_log = pass > 2;
        Picture8 picture = picture_of(chart);
        picture_end(&picture);
    }
}

static void draw_nothing(Canvas *canvas, const void *context) {
    (void)canvas;
    (void)context;
}

TEST(a_picture_without_end_is_an_error) {
    PlotBytes bytes;
    PictureSpec spec = {.width = 1e9, .height = 1e9, .scale = 1, .draw = draw_nothing};
    assert_fails_as(picture_draw(&spec, test_memory(), &bytes, &err), ERROR_LIBRARY,
                    "cairo cannot draw");
}

TEST_PROGRAM(make_arena, drop_arena)
