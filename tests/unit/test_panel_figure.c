/* SPDX-License-Identifier: Apache-2.0 */
/* Derived figures of the shipped panels: each is what its definition says of the panel's own
 * values, asked here one by one. */
#include "fixture.h"

#include "base/units.h"
#include "panel/figures/panel_figure.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_reflection.h"
#include "spectrum/photometry.h"

static Arena arena;
static const char *const NAMES[] = {"hud_pgu", "hud_pgu_p", "ips_cluster", "oled_centre",
                                    "zoned_centre"};
enum { PANELS = 5 };
static Panel *panels[PANELS];

static int start(void **state) {
    (void)state;
    arena = arena_reserve((size_t)1 << 34);
    for (int i = 0; i < PANELS; i++)
        assert_done(
            panel_open(arena_format(&arena, PROJECT_DIR "/assets/panels/%s.panel", NAMES[i]),
                       &arena, &panels[i], &err));
    return 0;
}

static int end(void **state) {
    (void)state;
    for (int i = 0; i < PANELS; i++) panel_close(panels[i]);
    arena_release(&arena);
    return 0;
}

static Vec3 towards(double deg, double phi) {
    double theta = radians_from_degrees(deg);
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
}

static void light(const Panel *panel, double deg, double phi, double code, double out[3]) {
    float xyz[3], c = (float)code;
    panel_emission_xyz(panel, towards(deg, phi), (float[3]){c, c, c}, xyz);
    for (int i = 0; i < 3; i++) out[i] = (double)xyz[i];
}

/* ---- viewing angle ----------------------------------------------------------------------- */

#define NOISE 1e-6 /* of 32-bit values */

static const PanelLimit limits[] = {{PANEL_LEAST_CONTRAST, 1000}, {PANEL_LEAST_CONTRAST, 10},
                                    {PANEL_LEAST_LUMINANCE, 0.5}, {PANEL_LEAST_LUMINANCE, 0.9},
                                    {PANEL_MOST_SHIFT, 0.01},     {PANEL_MOST_SHIFT, 0.02}};

/* Below 0 beyond the limit: relative, of a shift as it is. */
static double margin(const Panel *panel, const PanelLimit *limit, double deg, double phi) {
    double white[3], black[3], normal[3];
    light(panel, deg, phi, 255, white);
    light(panel, deg, phi, 0, black);
    light(panel, 0, 0, 255, normal);
    double d = white[0] + 15 * white[1] + 3 * white[2];
    double n = normal[0] + 15 * normal[1] + 3 * normal[2];
    double shift = hypot(4 * (white[0] / d - normal[0] / n), 9 * (white[1] / d - normal[1] / n));
    if (limit->kind == PANEL_MOST_SHIFT) return limit->value - shift;
    double least = limit->kind == PANEL_LEAST_CONTRAST ? black[1] : normal[1];
    return white[1] / (limit->value * least) - 1;
}

TEST(a_limit_is_held_up_to_its_angle_and_no_further) {
    int crossed = 0, kept = 0;
    for (int p = 0; p < PANELS; p++)
        for (size_t k = 0; k < sizeof limits / sizeof *limits; k++)
            for (int i = 0; i < 8; i++) {
                double phi = i * PI / 4, cone = panel_info_emission_cone(panels[p]);
                double found = panel_figure_viewing_angle(panels[p], NULL, limits[k], phi);
                double last = degrees_from_radians(isnan(found) ? cone : found);
                for (double deg = 0; deg < last - 1e-4; deg += 0.05)
                    assert_true(margin(panels[p], &limits[k], deg, phi) > -NOISE);
                if (isnan(found)) kept++;
                else if (found > 0) {
                    assert_true(margin(panels[p], &limits[k], last - 1e-4, phi) > -NOISE);
                    assert_true(margin(panels[p], &limits[k], last + 1e-4, phi) < NOISE);
                    crossed++;
                }
            }
    assert_true(crossed > 50 && kept > 50);
}

/* ---- light ------------------------------------------------------------------------------- */

TEST(contrast_and_colour_are_ratios_of_the_panels_light) {
    for (int p = 0; p < PANELS; p++)
        for (int i = 0; i < 12; i++) {
            double deg = 7 * i, phi = i, theta = radians_from_degrees(deg), white[3], black[3];
            light(panels[p], deg, phi, 255, white);
            light(panels[p], deg, phi, 0, black);
            double sum = white[0] + white[1] + white[2];
            PanelColour colour = panel_figure_colour(panels[p], theta, phi, PANEL_WHITE);
            double contrast = panel_figure_contrast(panels[p], theta, phi);
            assert_close(colour.xyz[1], white[1], 1e-9);
            assert_close(colour.xy[0], white[0] / sum, 1e-9);
            assert_close(colour.xy[1], white[1] / sum, 1e-9);
            assert_close(colour.uv[0], 4 * white[0] / (white[0] + 15 * white[1] + 3 * white[2]),
                         1e-9);
            if (black[1] > 0) assert_close(contrast, white[1] / black[1], 1e-9);
            else assert_true(isnan(contrast));
        }
}

/* Of the least squares the remainders are at right angles to the logarithms of the codes. */
TEST(gamma_leaves_nothing_along_the_line) {
    double code[PANEL_INFO_LEVELS_MAX], black[3], full[3], one[3];
    for (int p = 0; p < PANELS; p++)
        for (int deg = 0; deg <= 60; deg += 15) {
            double g = panel_figure_gamma(panels[p], PANEL_GREY, radians_from_degrees(deg), 1);
            double along = 0, size = 0;
            int count = panel_info_levels(panels[p], 1, code);
            light(panels[p], deg, 1, 0, black);
            light(panels[p], deg, 1, 255, full);
            assert_true(count > 2 && g > 1.5 && g < 3);
            for (int i = 0; i < count; i++) {
                light(panels[p], deg, 1, code[i], one);
                double x = log(code[i] / 255), y = log((one[1] - black[1]) / (full[1] - black[1]));
                along += x * (y - g * x);
                size += fabs(x * y);
            }
            assert_near(along / size, 0, 1e-6);
        }
}

/* ---- reflection -------------------------------------------------------------------------- */

TEST(reflectances_are_weighted_as_the_eye_does) {
    for (int p = 0; p < PANELS; p++)
        for (int deg = 8; deg < 80; deg += 26) {
            double mirror = 0, brdf = 0, weights = 0, theta = radians_from_degrees(deg);
            Vec3 wi = panel_figure_direction(theta, PI), wo = panel_figure_direction(theta, 0.02);
            for (int nm = SPECTRAL_FIRST_NM; nm <= SPECTRAL_LAST_NM; nm++) {
                Wavelengths w = {.nm = spectrum_all((float)nm)};
                double v = spectral_row(nm).y;
                mirror += v * (double)panel_mirror(panels[p], wi.z, &w)[0];
                brdf += v * (double)panel_brdf(panels[p], wo, wi, &w)[0];
                weights += v;
            }
            /* 16-bit steps of the file stay in a sum by tens */
            assert_close(panel_figure_mirror(panels[p], theta, 0), mirror / weights, 5e-4);
            assert_close(panel_figure_brdf(panels[p], wo, wi, 0), brdf / weights, 5e-4);
        }
}

TEST(the_haze_is_halfway_down_across_its_width) {
    for (int p = 0; p < PANELS; p++) {
        double theta = radians_from_degrees(8), up = 0, down = 0, step = radians_from_degrees(1e-4);
        PanelHaze haze = panel_figure_haze(panels[p], theta);
        Vec3 wi = panel_figure_direction(theta, PI);
        double rest = panel_figure_brdf(
            panels[p], panel_figure_direction(theta + radians_from_degrees(60), 0), wi, 0);
        assert_close(haze.peak_sr,
                     panel_figure_brdf(panels[p], panel_figure_direction(theta, 0), wi, 0), 1e-9);
        double half = 0.5 * (haze.peak_sr + rest);
        while (panel_figure_brdf(panels[p], panel_figure_direction(theta + up, 0), wi, 0) > half)
            up += step;
        while (panel_figure_brdf(panels[p], panel_figure_direction(theta - down, 0), wi, 0) > half)
            down += step;
        assert_near(haze.fwhm, up + down, 2 * step);
    }
}

TEST_PROGRAM(start, end)
