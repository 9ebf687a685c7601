/* SPDX-License-Identifier: Apache-2.0 */
/* Colour: the chromaticity diagram, the white point over angle, the primaries' spectra. */
#include <math.h>
#include <stdint.h>

#include "base/count.h"
#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "plot/draw/ticks.h"
#include "plot/panel/panel_chart.h"
#include "spectrum/gamut.h"
#include "spectrum/photometry.h"

/* ---- the diagram ------------------------------------------------------------------------ */

/* u', v' of a wavelength of the spectral locus. */
static void locus(int nm, double uv[2]) {
    const SpectralRow *row = &spectral_table[nm - SPECTRAL_FIRST_NM];
    uv_from_xyz((double[3]){(double)row->x, (double)row->y, (double)row->z}, uv);
}

/* The path of the horseshoe, closed by the purple line. */
static void locus_path(const Chart *chart) {
    cairo_t *cr = chart->canvas->cr;
    cairo_new_path(cr);
    for (int nm = 400; nm <= 700; nm++) {
        double uv[2];
        locus(nm, uv);
        cairo_line_to(cr, chart_x(chart, uv[0]), chart_y(chart, uv[1]));
    }
    cairo_close_path(cr);
}

/* A pale hint of the colour at u', v': the brightest that sRGB shows there, with paper. */
static uint32_t hint_of(const Canvas *canvas, double u, double v) {
    double y = 1, x = 9 * u / (4 * v), z = (12 - 3 * u - 20 * v) / (4 * v), high = 1e-9;
    float xyz[3] = {(float)x, (float)y, (float)z}, rgb[3];
    rgb_from_xyz(xyz, rgb);
    for (int c = 0; c < 3; c++) high = fmax(high, (double)rgb[c]);
    const double paper[3] = {canvas->theme.paper.red, canvas->theme.paper.green,
                             canvas->theme.paper.blue};
    uint32_t pixel = 0xff000000;
    for (int c = 0; c < 3; c++) {
        double code = pow(fmax((double)rgb[c] / high, 0.0), 1 / 2.2);
        double mixed = paper[c] + (canvas->theme.is_dark ? 0.34 : 0.42) * (code - paper[c]);
        pixel |= (uint32_t)(255 * mixed + 0.5) << (16 - 8 * c);
    }
    return pixel;
}

#define HINTS 220
#define HINTS_U 0.64 /* u' and v' up to here */
#define HINTS_V 0.6

static uint32_t hint_at(const void *canvas, int column, int row) {
    return hint_of(canvas, (column + 0.5) / HINTS * HINTS_U,
                   HINTS_V - (row + 0.5) / HINTS * HINTS_V);
}

static void paint_hints(const Chart *chart) {
    Canvas *canvas = chart->canvas;
    double left = chart_x(chart, 0), top = chart_y(chart, HINTS_V);
    cairo_save(canvas->cr);
    locus_path(chart);
    cairo_clip(canvas->cr);
    canvas_image(canvas, (Box){left, top, chart_x(chart, HINTS_U) - left, chart_y(chart, 0) - top},
                 &(CanvasRaster){HINTS, HINTS, CAIRO_FORMAT_RGB24, false, hint_at, canvas});
    cairo_restore(canvas->cr);
}

/* Under the series. */
static void draw_locus(const Chart *chart) {
    static const int MARKS[] = {420, 460, 480, 500, 520, 540, 560, 580, 600, 620, 660};
    Canvas *canvas = chart->canvas;
    paint_hints(chart);
    locus_path(chart);
    canvas_stroke(canvas, (Stroke){canvas->theme.faint, 1, DASH_NONE});
    for (int i = 0; i < COUNT_OF(MARKS); i++) {
        double uv[2], near[2];
        locus(MARKS[i], uv);
        locus(MARKS[i] + 2, near);
        double x = chart_x(chart, uv[0]), y = chart_y(chart, uv[1]);
        double dx = chart_x(chart, near[0]) - x, dy = chart_y(chart, near[1]) - y;
        double length = hypot(dx, dy) + 1e-9, nx = dy / length, ny = -dx / length;
        canvas_line(canvas, x, y, x + 3 * nx, y + 3 * ny,
                    (Stroke){canvas->theme.faint, 0.8, DASH_NONE});
        canvas_text(canvas, x + 6 * nx, y + 6 * ny,
                    (Letters){.size = 7.5,
                              .ink = canvas->theme.soft,
                              .across = 0.5 - 0.5 * nx,
                              .down = 0.5 - 0.5 * ny},
                    arena_format(canvas->arena, "%d", MARKS[i]));
    }
}

static GamutTriangle standard_uv(int i) {
    GamutTriangle xy = gamut_triangle((GamutStandard)i);
    return gamut_in_uv(&xy);
}

static bool panel_triangle(const PlotData *s, GamutTriangle *uv) {
    GamutTriangle srgb = standard_uv(GAMUT_SRGB);
    GamutTriangle xy = panel_figure_primaries(s->source.panel);
    *uv = gamut_in_uv(&xy);
    return !s->is_white_only && gamut_area(uv, &srgb) > 1e-4;
}

#define PATH_POINTS 81

/* From the normal to 80 degrees (or the cone's edge), every degree along one azimuth. */
static ChartPoints add_path(ChartRows *out, const PlotData *s, Pattern pattern, double phi,
                            Stroke stroke) {
    ChartPoints p = chart_rows_points(out, PATH_POINTS);
    float rgb[3];
    pattern_codes(pattern, rgb);
    p.count = 0;
    for (int deg = 0; deg < PATH_POINTS && radians_from_degrees(deg) <= s->cone + 1e-6; deg++) {
        PanelColour there =
            panel_figure_colour(s->source.panel, radians_from_degrees(deg), phi, rgb);
        p.x[p.count] = there.uv[0];
        p.y[p.count++] = there.uv[1];
    }
    chart_rows_add(
        out, SERIES_CURVE,
        arena_format(out->arena, "%s, φ %.0f°", pattern_name(pattern), degrees_from_radians(phi)),
        stroke, p);
    return p;
}

/* Where the points begin. */
static void add_start(ChartRows *out, ChartPoints points, double radius, Ink ink) {
    points.count = 1;
    chart_rows_add(out, SERIES_DOTS, NULL, (Stroke){ink, radius, DASH_NONE}, points);
}

static void add_paths(ChartRows *out, const PlotData *s, Pattern pattern) {
    Ink ink = panel_chart_pattern_ink(out->theme, pattern);
    ChartPoints path = {0};
    for (int k = 0; k < 8; k++)
        path = add_path(out, s, pattern, k * PI / 4, (Stroke){ink, 1.3, DASH_NONE});
    add_start(out, path, 3.6, out->theme->paper);
    add_start(out, path, 2.8, ink);
}

static void add_triangle(ChartRows *out, const GamutTriangle *uv, const char *name, Stroke stroke) {
    ChartPoints p = chart_rows_points(out, 4);
    for (int i = 0; i < 4; i++) p.x[i] = uv->at[i % 3][0], p.y[i] = uv->at[i % 3][1];
    Series *triangle = chart_rows_add(out, SERIES_CURVE, name, stroke, p);
    triangle->label = name;
    triangle->is_key = true;
}

/* Axes of u', v' whose units are as long. */
static void set_uv_axes(ChartRows *out, const double low[2], const double high[2]) {
    out->is_square = true;
    out->x = axis_even(low[0], high[0], "u′ (CIE 1976)");
    out->y = axis_even(low[1], high[1], "v′");
    out->right = 14;
}

static void fill_chromaticity(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    GamutTriangle srgb = standard_uv(GAMUT_SRGB), p3 = standard_uv(GAMUT_DCI_P3), uv;
    set_uv_axes(out, (double[2]){-0.02, -0.01}, (double[2]){0.66, 0.62});
    out->ground = draw_locus;
    out->key = KEY_LOWER_RIGHT;
    add_triangle(out, &srgb, "sRGB, BT.709", (Stroke){out->theme->soft, 0.9, DASH_DOT});
    add_triangle(out, &p3, "DCI-P3", (Stroke){out->theme->soft, 0.9, DASH_SHORT});
    if (panel_triangle(s, &uv)) {
        add_triangle(out, &uv, "this panel", (Stroke){out->theme->ink, 1.7, DASH_NONE});
        for (int p = PATTERN_RED; p <= PATTERN_BLUE; p++) add_paths(out, s, (Pattern)p);
    }
    add_paths(out, s, PATTERN_WHITE);
}

static void add_chromaticity(PanelChartList *list, const PlotData *s) {
    PanelColour white = plot_data_normal(s, PATTERN_WHITE);
    GamutTriangle uv, srgb = standard_uv(GAMUT_SRGB), p3 = standard_uv(GAMUT_DCI_P3);
    const char *area =
        panel_triangle(s, &uv)
            ? arena_format(s->arena, ", area %.0f %% of sRGB, %.0f %% of DCI-P3 in u′v′",
                           100 * gamut_area(&uv, &srgb), 100 * gamut_area(&uv, &p3))
            : "";
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_CHROMATICITY, "Chromaticity",
            arena_format(s->arena, "white u′ %.4f v′ %.4f%s", white.uv[0], white.uv[1], area),
            "Primaries and white in the CIE 1976 u′v′ diagram; the short paths run from the normal "
            "(dot) to θ 80° along eight azimuths.",
            fill_chromaticity, s, 0, SHEET_ALWAYS, false});
}

/* ---- the white point over angle --------------------------------------------------------- */

/* Rings of equal distance from the middle, with their Δu′v′. */
static void draw_steps(const Chart *chart) {
    Canvas *canvas = chart->canvas;
    Box p = chart->plot;
    double reach = 0.5 * fmin(chart->x.high - chart->x.low, chart->y.high - chart->y.low);
    double step = reach > 0.12    ? 0.05
                  : reach > 0.06  ? 0.02
                  : reach > 0.025 ? 0.01
                  : reach > 0.012 ? 0.005
                                  : 0.002;
    double x = p.x + 0.5 * p.w, y = p.y + 0.5 * p.h;
    cairo_save(canvas->cr);
    cairo_rectangle(canvas->cr, p.x, p.y, p.w, p.h);
    cairo_clip(canvas->cr);
    for (int k = 1; k <= 12; k++) {
        char text[32];
        double r = k * step * p.w / (chart->x.high - chart->x.low);
        canvas_circle(canvas, x, y, r);
        canvas_stroke(canvas, (Stroke){canvas->theme.faint, 0.7, DASH_SHORT});
        canvas_text(canvas, x - 0.7071 * r, y - 0.7071 * r,
                    (Letters){.size = 7.5,
                              .ink = canvas->theme.soft,
                              .across = 0.5,
                              .down = 0.5,
                              .halo = canvas->theme.paper},
                    tick_text(k * step, step, text));
    }
    cairo_restore(canvas->cr);
}

static Ink azimuth_ink(const Theme *theme, int k) {
    double t = 0.05 + 0.8 * k / 3.0;
    return panel_chart_ink(MAP_AMOUNT, theme->is_dark ? 1 - 0.85 * t : 0.9 * t);
}

static void fill_white_point(const PanelChart *shown, ChartRows *out) {
    static const char *const NAMES[] = {"φ 0°", "φ 90°", "φ 180°", "φ 270°"};
    const PlotData *s = shown->data;
    PanelColour normal = plot_data_normal(s, PATTERN_WHITE);
    double reach = 0.004;
    ChartPoints path = {0};
    for (int k = 3; k >= 0; k--) {
        ChartPoints marks = chart_rows_points(out, PATH_POINTS);
        Ink ink = azimuth_ink(out->theme, k);
        path = add_path(out, s, PATTERN_WHITE, k * PI / 2, (Stroke){ink, 1.6, (Dash)k});
        out->series[out->count - 1].label = NAMES[k];
        out->series[out->count - 1].is_key = true;
        marks.count = 0;
        for (int i = 0; i < path.count; i++) {
            double du = path.x[i] - normal.uv[0], dv = path.y[i] - normal.uv[1];
            reach = fmax(reach, fmax(fabs(du), fabs(dv)));
            if (i == 0 || i % 15) continue; /* degrees */
            marks.x[marks.count] = path.x[i];
            marks.y[marks.count++] = path.y[i];
        }
        chart_rows_add(out, SERIES_DOTS, NULL, (Stroke){ink, 2.2, DASH_NONE}, marks);
    }
    add_start(out, path, 3, out->theme->ink);
    reach *= 1.15;
    set_uv_axes(out, (double[2]){normal.uv[0] - reach, normal.uv[1] - reach},
                (double[2]){normal.uv[0] + reach, normal.uv[1] + reach});
    out->ground = draw_steps;
    out->key = KEY_LOWER_LEFT;
}

/* ---- spectra ---------------------------------------------------------------------------- */

#define SPECTRUM_POINTS 401 /* 380 to 780 nm */

static ChartPoints spectrum_of(const ChartRows *out, const PlotData *s, Pattern pattern) {
    ChartPoints p = chart_rows_points(out, SPECTRUM_POINTS);
    float rgb[3];
    pattern_codes(pattern, rgb);
    for (int first = 0; first < p.count; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = {0};
        for (int i = 0; i < SPECTRUM_LANES; i++)
            wavelengths.nm[i] = (float)fmin(380 + first + i, 780);
        Spectrum value = panel_emission_spectrum(s->source.panel, vec3(0, 0, 1), rgb, &wavelengths);
        for (int i = 0; i < SPECTRUM_LANES && first + i < p.count; i++) {
            p.x[first + i] = 380 + first + i;
            p.y[first + i] = (double)value[i];
        }
    }
    return p;
}

static int peak_of(ChartPoints p) {
    int peak = 0;
    for (int i = 1; i < p.count; i++)
        if (p.y[i] > p.y[peak]) peak = i;
    return peak;
}

static void fill_spectra(const PanelChart *shown, ChartRows *out) {
    ChartPoints spectrum[4];
    double high = 0;
    for (int p = 0; p < 4; p++) {
        spectrum[p] = spectrum_of(out, shown->data, (Pattern)p);
        high = fmax(high, spectrum[p].y[peak_of(spectrum[p])]);
    }
    int shift = (int)floor(log10(high) / 3) * 3; /* milli, micro: no row of zeros */
    double unit = pow(10, shift);
    for (int p = 0; p < 4; p++)
        for (int i = 0; i < SPECTRUM_POINTS; i++) spectrum[p].y[i] /= unit;
    for (int p = 1; p < 4; p++)
        chart_rows_add(out, SERIES_AREA, NULL,
                       (Stroke){.ink = ink_alpha(out->theme->primary[p - 1], 0.13)}, spectrum[p]);
    chart_rows_add(out, SERIES_CURVE, "White", (Stroke){out->theme->ink, 0.9, DASH_DOT},
                   spectrum[0]);
    for (int p = 1; p < 4; p++) {
        Ink ink = out->theme->primary[p - 1];
        const char *name = pattern_name((Pattern)p);
        int peak = peak_of(spectrum[p]);
        double nm = spectrum[p].x[peak];
        chart_rows_add(out, SERIES_CURVE, name, (Stroke){ink, 1.6, DASH_NONE}, spectrum[p]);
        Series *word = chart_rows_word(out, nm, spectrum[p].y[peak], ink,
                                       arena_format(out->arena, "%s %.0f nm", name, nm));
        word->dy = -7;
        word->across = 0.5;
    }
    out->x = (AxisSpec){.low = 380, .high = 780, .step = 50, .title = "Wavelength, nm"};
    out->y = axis_even(0, high / unit * 1.12,
                       shift == -3   ? "Spectral radiance, mW m⁻² sr⁻¹ nm⁻¹"
                       : shift == -6 ? "Spectral radiance, µW m⁻² sr⁻¹ nm⁻¹"
                       : shift == 0  ? "Spectral radiance, W m⁻² sr⁻¹ nm⁻¹"
                                     : "Spectral radiance");
    out->right = 14;
}

static void add_colour(PanelChartList *list, const PlotData *s) {
    if (!s->emits) return;
    add_chromaticity(list, s);
    panel_chart_add(
        list, &(PanelChart){
                  PLOT_CHROMATICITY, "White point over angle",
                  "dots every 15° of θ, rings of Δu′v′ around the normal",
                  "The chromaticity of full white from the normal to θ 80° along four azimuths.",
                  fill_white_point, s, 0, SHEET_ALWAYS, false});
    panel_chart_add(
        list,
        &(PanelChart){PLOT_SPECTRA, "Spectra at the normal",
                      "each primary at full drive; dotted: white",
                      "Spectral radiance at the normal of each primary at full drive and of white.",
                      fill_spectra, s, 0, SHEET_ALWAYS, true});
}

const PanelCharts colour_charts = {PLOT_CHROMATICITY, PLOT_SPECTRA, add_colour};
