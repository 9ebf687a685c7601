/* SPDX-License-Identifier: Apache-2.0 */
/* The parts of a picture: contour lines, ticks, colours, polar maps, documents. */
#include "fixture.h"

#include "base/units.h"
#include "image/srgb.h"
#include "plot/draw/chart.h"
#include "plot/draw/colour_map.h"
#include "plot/draw/field.h"
#include "plot/draw/polar.h"
#include "plot/draw/picture.h"
#include "plot/draw/ticks.h"

/* The leak sanitizer needs this: the font library keeps what it has found until the end. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libfontconfig";
}

/* ---- contour lines ---------------------------------------------------------------------- */

/* theta itself: its lines are circles around the centre. */
static Field theta_field(int side) {
    Field field = field_new(side, PI / 2, test_memory());
    for (int row = 0; row < side; row++)
        for (int column = 0; column < side; column++) {
            double x = column - (side - 1) / 2.0, y = row - (side - 1) / 2.0;
            field.value[row * side + column] = (float)(hypot(x, y) / ((side - 1) / 2.0) * PI / 2);
        }
    return field;
}

TEST(a_function_of_theta_has_circles) {
    enum { SIDE = 301 };
    Field field = theta_field(SIDE);
    for (int deg = 10; deg <= 80; deg += 10) {
        ContourSet set = contour_lines(field.value, SIDE, radians_from_degrees(deg), test_memory());
        assert_int_equal(set.count, 1);
        assert_true(set.line[0].is_closed);
        for (int i = 0; i < set.line[0].count; i++) {
            double r = hypot(set.line[0].point[i].x - 150, set.line[0].point[i].y - 150);
            assert_near(r, 150 * deg / 90.0, 0.02);
        }
    }
}

/* Every point lies where the bilinear function has the level, whatever the function. */
TEST(lines_lie_on_their_level) {
    enum { SIDE = 61 };
    Field field = field_new(SIDE, PI / 2, test_memory());
    for (int i = 0; i < SIDE * SIDE; i++)
        field.value[i] = (float)(sin(0.21 * (i % SIDE)) * cos(0.17 * (i / SIDE)) + 0.01 * (i % 7));
    for (int k = -6; k <= 6; k++) {
        double level = 0.13 * k + 0.003;
        ContourSet set = contour_lines(field.value, SIDE, level, test_memory());
        for (int n = 0; n < set.count; n++)
            for (int i = 0; i < set.line[n].count; i++) {
                ContourPoint p = set.line[n].point[i];
                assert_near(field_at(&field, p.x, p.y), level, 1e-5);
            }
    }
}

/* No edge with a crossing is left out and none counts twice. */
TEST(every_crossing_is_on_one_line) {
    enum { SIDE = 40 };
    float value[SIDE * SIDE];
    unsigned random = 1;
    int crossings = 0, points = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        random = random * 1664525u + 1013904223u;
        value[i] = (float)(random >> 8) / 16777216.0f;
    }
    for (int row = 0; row < SIDE; row++)
        for (int c = 0; c < SIDE; c++) {
            bool here = value[row * SIDE + c] >= 0.5f;
            crossings += c + 1 < SIDE && here != (value[row * SIDE + c + 1] >= 0.5f);
            crossings += row + 1 < SIDE && here != (value[(row + 1) * SIDE + c] >= 0.5f);
        }
    ContourSet set = contour_lines(value, SIDE, 0.5, test_memory());
    for (int i = 0; i < set.count; i++)
        points += set.line[i].count - (set.line[i].is_closed ? 1 : 0);
    assert_int_equal(points, crossings);
}

TEST(holes_have_no_lines) {
    enum { SIDE = 41 };
    Field field = theta_field(SIDE);
    for (int row = 0; row < SIDE; row++)
        for (int c = 0; c < 20; c++) field.value[row * SIDE + c] = NAN;
    ContourSet set = contour_lines(field.value, SIDE, PI / 4, test_memory());
    assert_int_equal(set.count, 1);
    assert_false(set.line[0].is_closed);
    for (int i = 0; i < set.line[0].count; i++) assert_true(set.line[0].point[i].x >= 20);
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

/* CIE 1976 lightness of an sRGB colour, 0 to 100 (IEC 61966-2-1's luminance). */
static double lightness_from_srgb(const double srgb[3]) {
    double y = 0.2126 * linear_from_srgb_d(srgb[0]) + 0.7152 * linear_from_srgb_d(srgb[1]) +
               0.0722 * linear_from_srgb_d(srgb[2]);
    return y > 216.0 / 24389 ? 116 * cbrt(y) - 16 : y * 24389.0 / 27;
}

/* ---- colours ---------------------------------------------------------------------------- */

static double lightness_at(ColourMap map, double t) {
    double srgb[3];
    colour_map_at(map, t, srgb);
    for (int c = 0; c < 3; c++) assert_true(srgb[c] >= 0 && srgb[c] <= 1);
    return lightness_from_srgb(srgb);
}

TEST(lightness_follows_the_number) {
    for (int map = 0; map < MAP_COUNT; map++) {
        if (map == MAP_SIGNED) continue;
        double first = lightness_at((ColourMap)map, 0), last = lightness_at((ColourMap)map, 1);
        assert_true(fabs(last - first) > 55);
        for (int i = 0; i <= 256; i++) {
            double t = i / 256.0;
            assert_near(lightness_at((ColourMap)map, t), first + t * (last - first), 0.6);
        }
    }
    assert_true(lightness_at(MAP_DIFFERENCE, 0) > 95); /* nothing is paper */
}

TEST(signed_colours_are_even_on_both_sides) {
    for (int i = 1; i <= 100; i++) {
        double t = i / 200.0;
        assert_true(lightness_at(MAP_SIGNED, t) > lightness_at(MAP_SIGNED, t - 0.005));
        assert_true(lightness_at(MAP_SIGNED, 1 - t) > lightness_at(MAP_SIGNED, 1.005 - t));
        assert_near(lightness_at(MAP_SIGNED, t), lightness_at(MAP_SIGNED, 1 - t), 6);
    }
    double low[3], high[3];
    colour_map_at(MAP_SIGNED, 0.1, low);
    colour_map_at(MAP_SIGNED, 0.9, high);
    assert_true(low[2] > low[0] && high[0] > high[2]); /* blue is below */
}

TEST(light_and_white_have_their_lightness) {
    assert_near(lightness_from_srgb((double[3]){1, 1, 1}), 100, 1e-9);
    assert_near(lightness_from_srgb((double[3]){0, 0, 0}), 0, 1e-12);
    double grey = 0.46613; /* linear 0.18419: L* 50 */
    assert_near(lightness_from_srgb((double[3]){grey, grey, grey}), 50, 0.1);
    assert_true(colour_map_wants_light_ink(MAP_AMOUNT, 0));
    assert_false(colour_map_wants_light_ink(MAP_AMOUNT, 1));
}

/* ---- the polar map ---------------------------------------------------------------------- */

#define SCALE 4 /* pixels per point */
#define SIZE 400

typedef struct Picture8 {
    cairo_surface_t *surface;
    Canvas canvas;
} Picture8;

static Picture8 picture_start(void) {
    Picture8 picture = {cairo_image_surface_create(CAIRO_FORMAT_RGB24, SIZE * SCALE, SIZE * SCALE),
                        {0}};
    picture.canvas = (Canvas){cairo_create(picture.surface), theme_light(), SCALE, test_memory()};
    cairo_scale(picture.canvas.cr, SCALE, SCALE);
    cairo_rectangle(picture.canvas.cr, 0, 0, SIZE, SIZE);
    canvas_fill(&picture.canvas, picture.canvas.theme.paper);
    return picture;
}

static double pixel_lightness(const Picture8 *picture, double x, double y) {
    int stride = cairo_image_surface_get_stride(picture->surface);
    const unsigned char *data = cairo_image_surface_get_data(picture->surface);
    const unsigned char *p = data + (int)(y * SCALE) * stride + 4 * (int)(x * SCALE);
    return lightness_from_srgb((double[3]){p[2] / 255.0, p[1] / 255.0, p[0] / 255.0});
}

static void picture_end(Picture8 *picture) {
    cairo_surface_flush(picture->surface);
    assert_int_equal(cairo_status(picture->canvas.cr), CAIRO_STATUS_SUCCESS);
    cairo_destroy(picture->canvas.cr);
    cairo_surface_destroy(picture->surface);
}

/* Where the light line crosses the ray, points from the centre: the middle of its lightness. */
static double line_radius(const Picture8 *picture, PolarPlace disc, double phi, double near) {
    double sum = 0, weighted = 0, ground = 0;
    for (double r = near - 4; r < near + 4; r += 0.05) {
        double l = pixel_lightness(picture, disc.x + r * cos(phi), disc.y - r * sin(phi));
        if (r == near - 4) ground = l;
        if (l < ground + 4) continue;
        sum += l - ground;
        weighted += (l - ground) * r;
    }
    return weighted / sum;
}

TEST(the_ring_of_50_degrees_is_at_five_ninths) {
    Field field = theta_field(301);
    PolarMap map = {.field = &field,
                    .map = MAP_AMOUNT,
                    .high = 40,
                    .strong = NAN,
                    .level_count = 1,
                    .level = {radians_from_degrees(50)},
                    .theta_measured = PI / 2,
                    .unit = "",
                    .step = 1};
    Picture8 picture = picture_start();
    PolarPlace disc = polar_draw(&picture.canvas, (Box){0, 0, SIZE, SIZE}, &map);
    cairo_surface_flush(picture.surface);
    for (int deg = 10; deg < 360; deg += 10) {
        if (deg % 45 == 0 || (deg > 80 && deg < 130)) continue; /* spokes; the line's number */
        double r = line_radius(&picture, disc, radians_from_degrees(deg), disc.radius * 5 / 9);
        assert_near(r * SCALE, disc.radius * 5 / 9 * SCALE, 0.3 * SCALE);
    }
    picture_end(&picture);
}

TEST(what_was_not_measured_is_dimmed_and_hatched) {
    Field field = field_new(61, PI / 2, test_memory());
    for (int i = 0; i < 61 * 61; i++) field.value[i] = 0.1f;
    PolarMap map = {.field = &field,
                    .map = MAP_AMOUNT,
                    .high = 1,
                    .strong = NAN,
                    .theta_measured = radians_from_degrees(50),
                    .unit = ""};
    Picture8 picture = picture_start();
    PolarPlace disc = polar_draw(&picture.canvas, (Box){0, 0, SIZE, SIZE}, &map);
    cairo_surface_flush(picture.surface);
    double inside =
        pixel_lightness(&picture, disc.x + 0.30 * disc.radius, disc.y - 0.12 * disc.radius);
    double low = 100, high = 0;
    for (double r = 0.92; r < 0.98; r += 0.001) {
        double l = pixel_lightness(&picture, disc.x + r * disc.radius * cos(0.3),
                                   disc.y - r * disc.radius * sin(0.3));
        low = fmin(low, l);
        high = fmax(high, l);
    }
    assert_near(inside, lightness_at(MAP_AMOUNT, 0.1), 1.5);
    assert_true(low > inside + 10); /* dimmed with paper everywhere */
    assert_true(high > low + 4);    /* and hatched */
    picture_end(&picture);
}

/* ---- fields ----------------------------------------------------------------------------- */

TEST(a_grid_point_looks_where_it_stands) {
    Field field = field_new(91, PI / 2, test_memory());
    for (int deg = 0; deg < 360; deg += 30) {
        double column, row, phi = radians_from_degrees(deg);
        field_place(&field, radians_from_degrees(60), phi, &column, &row);
        Vec3 d = field_direction(&field, (int)nearbyint(row), (int)nearbyint(column));
        double azimuth = atan2((double)d.y, (double)d.x);
        assert_near(remainder(azimuth - phi, 2 * PI), 0, 0.02);
        assert_near(acos((double)d.z), radians_from_degrees(60), 0.03);
    }
    Vec3 up = field_direction(&field, 0, 45), out = field_direction(&field, 0, 0);
    assert_true(up.y > 0.99f && up.z > 0); /* row 0 is the top; the rim looks just above it */
    assert_true(out.z > 0);
}

TEST(quantiles_and_ranges_agree) {
    Field field = theta_field(101);
    FieldRange range = field_range(&field, radians_from_degrees(45));
    assert_near(range.low, 0, 1e-6);
    assert_near(range.high, radians_from_degrees(45), 0.02);
    /* the area inside theta grows as its square on this map */
    assert_near(field_quantile(&field, PI / 2, 0.25, *test_memory()), PI / 4, 0.02);
}

/* ---- charts and documents --------------------------------------------------------------- */

TEST(axes_put_values_where_they_belong) {
    Picture8 picture = picture_start();
    Chart chart = chart_open(
        &picture.canvas, (Box){0, 0, SIZE, SIZE}, (AxisSpec){.low = -90, .high = 90, .title = "x"},
        (AxisSpec){.low = 0.01, .high = 100, .is_log = true, .title = "y"}, 20);
    assert_near(chart_x(&chart, -90), chart.plot.x, 1e-9);
    assert_near(chart_x(&chart, 0), chart.plot.x + chart.plot.w / 2, 1e-9);
    assert_near(chart_y(&chart, 0.01), chart.plot.y + chart.plot.h, 1e-9);
    assert_near(chart_y(&chart, 1), chart.plot.y + chart.plot.h / 2, 1e-9);
    for (int i = 0; i < 6; i++) chart_name(&chart, 90, 1, picture.canvas.theme.ink, "name");
    chart_close(&chart);
    picture_end(&picture);
}

TEST(ids_are_renamed_alike_and_apart) {
    char text[] = "<?xml version=\"1.0\"?>\n<svg><g id=\"glyph0-1\"/><clipPath id=\"clip7\"/>"
                  "<use xlink:href=\"#glyph0-1\"/><g clip-path=\"url(#clip7)\"/>"
                  "<path d=\"M 1.23456 2.000001 L 3 4.5\"/></svg>";
    PlotBytes in = {(unsigned char *)text, sizeof text - 1};
    PlotBytes out = picture_with_ids(in, "a", true, test_memory());
    assert_string_equal((char *)out.data,
                        "<svg><g id=\"a0\"/><clipPath id=\"a1\"/><use xlink:href=\"#a0\"/>"
                        "<g clip-path=\"url(#a1)\"/><path d=\"M 1.234 2 L 3 4.5\"/></svg>");
    assert_int_equal(out.size, strlen((char *)out.data));
}

TEST(data_without_spread_have_a_picture) {
    Picture8 picture = picture_start();
    Field field = field_new(31, PI / 2, test_memory());
    for (int pass = 0; pass < 3; pass++) {
        for (int i = 0; i < 31 * 31; i++) field.value[i] = pass == 2 ? NAN : 0;
        polar_draw(&picture.canvas, (Box){0, 0, SIZE, SIZE},
                   &(PolarMap){.field = &field,
                               .is_log = pass == 1,
                               .strong = NAN,
                               .theta_measured = PI / 2,
                               .unit = ""});
        Chart chart = chart_open(&picture.canvas, (Box){0, 0, SIZE, SIZE}, (AxisSpec){.title = "x"},
                                 (AxisSpec){.is_log = pass == 1, .title = "y"}, 20);
        chart_close(&chart);
    }
    picture_end(&picture);
}

TEST_PROGRAM(make_arena, drop_arena)
