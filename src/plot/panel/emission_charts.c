/* SPDX-License-Identifier: Apache-2.0 */
/* What the panel emits: white, its contrast and colour over the hemisphere, two sections, the
 * chromaticity diagram and grey levels at several angles. */
#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "plot/draw/ticks.h"
#include "plot/panel/plot_charts.h"
#include "spectrum/gamut.h"
#include "spectrum/photometry.h"

/* ---- over the hemisphere ----------------------------------------------------------------- */

#define HEMISPHERE \
    "over the viewing hemisphere: θ from the normal outwards, φ counter-clockwise from the " \
    "viewer's right."

static Chart *hemisphere(const PlotData *s, const char *title, const char *unit,
                         ChartQuantity *quantity) {
    Chart *chart = chart_new(CHART_POLAR, title, NULL, unit, s->arena);
    chart->measured[1] = degrees_from_radians(s->cone);
    chart_fill(chart, quantity, s);
    return chart;
}

/* "; measured at φ 0° alone", or "PREFIX at θ 40°, φ 90°". */
static const char *at_row(const PlotData *s, const Chart *chart, int row, const char *prefix) {
    if (s->azimuths) return arena_format(s->arena, "; %s", s->azimuths);
    double theta = chart_cell(chart, row, 0);
    return theta < 0.75 ? ""
                        : arena_format(s->arena, "%s at θ %.0f°, φ %.0f°", prefix, theta,
                                       chart_cell(chart, row, 1));
}

static double white_at(const void *context, double theta, double phi) {
    return panel_figure_luminance(((const PlotData *)context)->panel, theta, phi, PANEL_WHITE);
}

static double contrast_at(const void *context, double theta, double phi) {
    return panel_figure_contrast(((const PlotData *)context)->panel, theta, phi);
}

static double shift_at(const void *context, double theta, double phi) {
    return panel_figure_shift(((const PlotData *)context)->panel, theta, phi, PANEL_WHITE);
}

static void add_luminance(PlotCharts *charts, const PlotData *s) {
    char text[2][32];
    Chart *chart = hemisphere(s, "Luminance, white", "cd/m²", white_at);
    ChartRange range = chart_range(chart, chart->measured[1]);
    double normal = chart_cell(chart, 0, 2);
    /* within two percent everywhere: over all colours that would be a map of noise */
    bool is_even = range.high - range.low < 0.02 * range.high;
    const char *most = arena_format(s->arena, ", at most %s", figure_text(range.high, text[0]));
    if (!(range.high > 0)) return;
    chart->y.high = range.high;
    chart->y.low = is_even ? 0.9 * range.low : range.low > 0.6 * range.high ? range.low : 0;
    if (range.low < 0.5 * normal && 0.5 * normal < range.high) chart->strong = 0.5 * normal;
    chart->subtitle =
        arena_format(s->arena, "%s cd/m² at the normal%s%s", figure_text(normal, text[1]),
                     is_even ? ", nearly constant" : "", at_row(s, chart, range.highest, most));
    chart->caption = "Luminance in cd/m² " HEMISPHERE
                     " Thin lines: at the scale's numbers. The strong ring, where there is one, is "
                     "half the luminance of the normal.";
    plot_add(charts, chart);
}

/* Beyond it black is next to nothing and high ratios are noise: they do not set the colours. */
#define GRAZING_DEG 80.0

static void add_contrast(PlotCharts *charts, const PlotData *s) {
    char text[2][32];
    if (!s->has_black || s->is_white_only) return;
    Chart *chart = hemisphere(s, "Contrast ratio", ": 1", contrast_at);
    double cone = chart->measured[1], low = chart_range(chart, cone).low;
    ChartRange range = chart_range(chart, fmin(cone, GRAZING_DEG));
    chart->y =
        (ChartAxis){round_down(fmax(low, range.high / 1e5)), round_up(range.high), .is_log = true};
    if (chart->y.high < 2 * chart->y.low) chart->y.low = chart->y.high / 2;
    chart->subtitle = arena_format(
        s->arena, "white over black: %s at the normal%s",
        figure_text(chart_cell(chart, 0, 2), text[0]),
        s->azimuths ? arena_format(s->arena, "; %s", s->azimuths)
                    : arena_format(s->arena, ", at least %s", figure_text(low, text[1])));
    chart->caption =
        "Luminance of white over that of black in a dark room " HEMISPHERE " Logarithmic colours.";
    plot_add(charts, chart);
}

static void add_shift(PlotCharts *charts, const PlotData *s) {
    char text[32];
    Chart *chart = hemisphere(s, "Colour shift, white", "Δu′v′", shift_at);
    ChartRange range = chart_range(chart, chart->measured[1]);
    chart->y.high = fmax(range.high, 0.005);
    chart->subtitle =
        arena_format(s->arena, "Δu′v′ from the normal, at most %s%s", figure_text(range.high, text),
                     at_row(s, chart, range.highest, ""));
    chart->caption = "Distance Δu′v′ in the CIE 1976 chromaticity plane between white at an angle "
                     "and white at the normal.";
    plot_add(charts, chart);
}

/* ---- sections ---------------------------------------------------------------------------- */

/* Where white falls below half of the normal's luminance, degrees; side -1: the opposite
 * azimuth, and below 0. NaN: not within the measured cone. */
static double half_angle_deg(const PlotData *s, double phi, int side) {
    return side * degrees_from_radians(panel_figure_viewing_angle(
                      s->panel, NULL, (PanelLimit){PANEL_LEAST_LUMINANCE, 0.5},
                      side < 0 ? phi + PI : phi));
}

static void add_half(Chart *chart, double deg, double half) {
    if (isnan(deg)) return;
    chart_series(chart, "half of white", (Stroke){INK_ACCENT, 0.9, DASH_SHORT});
    chart_point(chart, deg, 0);
    chart_point(chart, deg, half);
}

static Ink pattern_ink(int pattern) {
    return pattern == PATTERN_WHITE ? INK_TEXT : ink_of_primary(pattern - PATTERN_RED);
}

static void add_section(PlotCharts *charts, const PlotData *s, bool is_vertical) {
    static const Dash DASHES[] = {DASH_NONE, DASH_LONG, DASH_NONE, DASH_SHORT};
    double phi = is_vertical ? PI / 2 : 0, cone = degrees_from_radians(s->cone);
    Chart *chart = chart_new(CHART_AXES, is_vertical ? "Vertical section" : "Horizontal section",
                             is_vertical ? "θ along φ 270° (down) to 90° (up)"
                                         : "θ along φ 180° (left) to 0° (right)",
                             "Luminance, cd/m²", s->arena);
    chart->x = (ChartAxis){.low = -90, .high = 90, .step = 30, .suffix = "°"};
    chart->measured[0] = -cone;
    chart->measured[1] = cone;
    for (int p = 0; p <= (s->is_white_only ? PATTERN_WHITE : PATTERN_BLUE); p++) {
        Stroke stroke = {pattern_ink(p), p ? 1.4 : 1.9, DASHES[p]};
        chart_series(chart, pattern_name((Pattern)p), stroke)->is_key = true;
        for (int i = 0; i <= 352; i++) {
            double deg = -88 + 0.5 * i;
            chart_point(chart, deg,
                        panel_figure_luminance(s->panel, radians_from_degrees(deg), phi,
                                               pattern_codes((Pattern)p)));
        }
    }
    chart->y.high = 1.1 * chart_range(chart, 0).high;
    double left = half_angle_deg(s, phi, -1), right = half_angle_deg(s, phi, 1);
    double half = 0.5 * panel_figure_luminance(s->panel, 0, 0, PANEL_WHITE);
    add_half(chart, left, half);
    add_half(chart, right, half);
    chart->subtitle =
        isnan(left) && isnan(right)
            ? arena_format(s->arena, "white keeps above half its luminance within ±%.3g°", cone)
        : isnan(left) || isnan(right)
            ? arena_format(s->arena, "half the luminance of white at %+.1f°",
                           isnan(left) ? right : left)
            : arena_format(s->arena, "half the luminance of white at −%.1f° and +%.1f°", -left,
                           right);
    for (int p = 0; s->measured && p < 3; p++) {
        const MeasuredPrimary *primary = &s->measured->primary[p];
        int last = primary->level_count - 1;
        if (last < 0 || !(primary->level[last] > 254)) continue;
        plot_samples(chart, &primary->table[last], 1, phi, ink_of_primary(p));
    }
    chart->caption = "Luminance in cd/m² over the angle from the normal, for full white and the "
                     "three primaries alone. Rings: the samples of the set, where it is given.";
    plot_add(charts, chart);
}

/* ---- chromaticity ------------------------------------------------------------------------ */

static void add_triangle(Chart *chart, const GamutTriangle *uv, const char *name, Stroke stroke) {
    chart_series(chart, name, stroke)->is_key = true;
    for (int i = 0; i < 4; i++) chart_point(chart, uv->at[i % 3][0], uv->at[i % 3][1]);
}

/* Closed by the purple line. */
static void add_locus(Chart *chart) {
    chart_series(chart, "spectral locus", (Stroke){INK_FAINT, 1, DASH_NONE});
    for (int nm = 400; nm <= 701; nm++) {
        const SpectralRow *row = &spectral_table[(nm > 700 ? 400 : nm) - SPECTRAL_FIRST_NM];
        double uv[2];
        uv_from_xyz((double[3]){(double)row->x, (double)row->y, (double)row->z}, uv);
        chart_point(chart, uv[0], uv[1]);
    }
}

/* From the normal to 80 degrees (or the cone's edge). */
static void add_paths(Chart *chart, const PlotData *s, int pattern) {
    for (int k = 0; k < 4; k++) {
        chart_series(chart,
                     arena_format(s->arena, "%s, φ %d°", pattern_name((Pattern)pattern), 90 * k),
                     (Stroke){pattern_ink(pattern), 1.4, DASH_NONE});
        for (int deg = 0; deg <= 80 && radians_from_degrees(deg) <= s->cone + 1e-6; deg += 2) {
            PanelColour there = panel_figure_colour(s->panel, radians_from_degrees(deg), k * PI / 2,
                                                    pattern_codes((Pattern)pattern));
            chart_point(chart, there.uv[0], there.uv[1]);
        }
    }
    Series *start = chart_series(chart, pattern_name((Pattern)pattern),
                                 (Stroke){pattern_ink(pattern), 2, DASH_NONE});
    PanelColour normal = panel_figure_colour(s->panel, 0, 0, pattern_codes((Pattern)pattern));
    start->has_rings = true;
    chart_point(chart, normal.uv[0], normal.uv[1]);
}

static void add_chromaticity(PlotCharts *charts, const PlotData *s) {
    GamutTriangle xy[3] = {panel_figure_primaries(s->panel), gamut_triangle(GAMUT_SRGB),
                           gamut_triangle(GAMUT_DCI_P3)};
    GamutTriangle uv[3];
    for (int i = 0; i < 3; i++) uv[i] = gamut_in_uv(&xy[i]);
    PanelColour white = panel_figure_colour(s->panel, 0, 0, PANEL_WHITE);
    Chart *chart = chart_new(CHART_AXES, "Chromaticity", "u′ (CIE 1976)", "v′", s->arena);
    chart->is_square = true;
    chart->x = (ChartAxis){.low = -0.02, .high = 0.66};
    chart->y = (ChartAxis){.low = -0.01, .high = 0.62};
    add_locus(chart);
    add_triangle(chart, &uv[1], "sRGB", (Stroke){INK_SOFT, 0.9, DASH_DOT});
    add_triangle(chart, &uv[2], "DCI-P3", (Stroke){INK_SOFT, 0.9, DASH_SHORT});
    if (!s->is_white_only)
        add_triangle(chart, &uv[0], "this panel", (Stroke){INK_TEXT, 1.7, DASH_NONE});
    for (int p = 0; p <= (s->is_white_only ? PATTERN_WHITE : PATTERN_BLUE); p++)
        add_paths(chart, s, p);
    chart->subtitle =
        arena_format(s->arena, "white u′ %.4f v′ %.4f%s", white.uv[0], white.uv[1],
                     s->is_white_only ? ""
                                      : arena_format(s->arena,
                                                     ", area %.0f %% of sRGB, %.0f %% of DCI-P3 "
                                                     "in u′v′",
                                                     100 * gamut_area(&uv[0], &uv[1]),
                                                     100 * gamut_area(&uv[0], &uv[2])));
    chart->caption = "Primaries and white in the CIE 1976 u′v′ diagram; the short paths run from "
                     "the normal (ring) to θ 80° along four azimuths.";
    plot_add(charts, chart);
}

/* ---- grey levels ------------------------------------------------------------------------- */

/* Luminance of grey above black over that of white above black. */
static void add_greys(Chart *chart, const PlotData *s, int theta_deg, int phi_deg, Stroke stroke) {
    double theta = radians_from_degrees(theta_deg), phi = radians_from_degrees(phi_deg);
    double black = panel_figure_luminance(s->panel, theta, phi, PANEL_BLACK);
    double white = panel_figure_luminance(s->panel, theta, phi, PANEL_WHITE);
    chart_series(chart, arena_format(s->arena, "θ %d°, φ %d°", theta_deg, phi_deg), stroke)
        ->is_key = true;
    for (int i = 8; i <= 255; i++) {
        const float rgb[3] = {(float)i, (float)i, (float)i};
        chart_point(chart, i,
                    (panel_figure_luminance(s->panel, theta, phi, rgb) - black) / (white - black));
    }
}

/* The set's samples nearest to the normal, at levels that all primaries have. */
static void add_measured_greys(Chart *chart, const Measurement *set) {
    const MeasuredPrimary *first = &set->primary[0];
    double black = set->has_black ? 3 * (double)set->black.value[1] : 0, sum[2] = {0, 0};
    Series *series = chart_series(chart, "measured", (Stroke){INK_ACCENT, 1, DASH_NONE});
    series->has_rings = series->is_key = true;
    for (int i = first->level_count - 1; i >= 0; i--) {
        sum[1] = -black;
        for (int p = 0; p < 3; p++) {
            const MeasuredPrimary *primary = &set->primary[p];
            if (primary->level_count != first->level_count ||
                fabs(primary->level[i] - first->level[i]) > 1e-6)
                return;
            sum[1] += (double)primary->table[i].value[1];
        }
        if (i == first->level_count - 1) sum[0] = sum[1];
        chart_point(chart, first->level[i], sum[1] / sum[0]);
    }
}

/* The lowest code at which every primary was measured. */
static double first_level(const PlotData *s) {
    double first = 0, code[PANEL_INFO_LEVELS_MAX];
    for (int p = 0; p < 3; p++)
        if (panel_info_levels(s->panel, p, code) > 0) first = fmax(first, code[0]);
    return first;
}

static void add_grey_levels(PlotCharts *charts, const PlotData *s) {
    double code[PANEL_INFO_LEVELS_MAX];
    if (s->is_white_only ? !s->has_gamma_table : panel_info_levels(s->panel, 1, code) < 2) return;
    Chart *chart = chart_new(CHART_AXES, "Grey levels", "Grey level, code of 255",
                             "Luminance above black, relative to white", s->arena);
    chart->x = (ChartAxis){8, 256, .is_log = true};
    chart->y = (ChartAxis){3e-4, 1.2, .is_log = true};
    chart->measured[0] = first_level(s);
    for (int theta = 0; theta <= 60; theta += 30)
        for (int phi = 0; phi <= (theta ? 270 : 0); phi += 90) {
            static const Dash DASHES[] = {DASH_NONE, DASH_LONG, DASH_SHORT, DASH_DOT};
            add_greys(
                chart, s, theta, phi,
                (Stroke){ink_of_amount(0.05 + 0.008 * theta), theta ? 1.3 : 1.9, DASHES[phi / 90]});
        }
    if (s->measured && !s->is_white_only) add_measured_greys(chart, s->measured);
    chart->subtitle = s->has_gamma_table ? "a gamma table of the normal, taken for every angle"
                                         : "where curves of one angle cross, greys are inverted";
    chart->caption =
        "Luminance of grey (red, green and blue at one code) above that of black, divided by that "
        "of white, at several angles; a power law is a straight line. Hatched: below the first "
        "measured level. Rings: the samples of the set at the normal, where it is given.";
    plot_add(charts, chart);
}

static void add_all(PlotCharts *charts, const PlotData *data, PlotKind kind) {
    if (plot_wants(kind, PLOT_LUMINANCE)) add_luminance(charts, data);
    if (plot_wants(kind, PLOT_CONTRAST)) add_contrast(charts, data);
    if (plot_wants(kind, PLOT_COLOUR_SHIFT)) add_shift(charts, data);
    for (int i = 0; i < 2 && plot_wants(kind, PLOT_SECTIONS); i++)
        add_section(charts, data, i == 1);
    if (plot_wants(kind, PLOT_CHROMATICITY)) add_chromaticity(charts, data);
    if (plot_wants(kind, PLOT_GREY_LEVELS)) add_grey_levels(charts, data);
}

PlotAdd *const emission_charts = add_all;
