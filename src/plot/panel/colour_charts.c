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

static void draw_triangle(const Chart *chart, double uv[3][2], Stroke stroke) {
    cairo_t *cr = chart->canvas->cr;
    for (int i = 0; i < 3; i++)
        cairo_line_to(cr, chart_x(chart, uv[i][0]), chart_y(chart, uv[i][1]));
    cairo_close_path(cr);
    canvas_stroke(chart->canvas, stroke);
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

/* From the normal to 80 degrees (or the cone's edge), along one azimuth. */
static int angle_path(const PlotData *s, Pattern pattern, double phi, double u[], double v[]) {
    float rgb[3];
    int count = 0;
    pattern_codes(pattern, rgb);
    for (int deg = 0; deg <= 80 && radians_from_degrees(deg) <= s->cone + 1e-6; deg++) {
        PanelColour there =
            panel_figure_colour(s->source.panel, radians_from_degrees(deg), phi, rgb);
        u[count] = there.uv[0];
        v[count++] = there.uv[1];
    }
    return count;
}

static void draw_paths(Chart *chart, const PlotData *s, Pattern pattern, Ink ink) {
    double u[81], v[81];
    for (int k = 0; k < 8; k++) {
        int count = angle_path(s, pattern, k * PI / 4, u, v);
        chart_curve(chart, u, v, count, (Stroke){ink, 1.3, DASH_NONE});
    }
    PanelColour normal = plot_data_normal(s, pattern);
    chart_dot(chart, normal.uv[0], normal.uv[1], 3.6, chart->canvas->theme.paper);
    chart_dot(chart, normal.uv[0], normal.uv[1], 2.8, ink);
}

/* Axes of equal scale on both, centred. */
static Chart square_chart(Canvas *canvas, Box box, const double low[2], const double high[2],
                          const char *const titles[2]) {
    double w = box.w - 42 - 14, h = box.h - 56;
    double scale = fmin(w / (high[0] - low[0]), h / (high[1] - low[1]));
    double span[2] = {w / scale, h / scale}, from[2];
    for (int i = 0; i < 2; i++) from[i] = (low[i] + high[i] - span[i]) / 2;
    return chart_open(
        canvas, box, (AxisSpec){.low = from[0], .high = from[0] + span[0], .title = titles[0]},
        (AxisSpec){.low = from[1], .high = from[1] + span[1], .title = titles[1]}, 14);
}

static const char *const UV_TITLES[2] = {"u′ (CIE 1976)", "v′"};

static void draw_chromaticity(Canvas *canvas, Box box, const PanelChart *shown,
                              PanelChartMap *out) {
    const PlotData *s = shown->data;
    GamutTriangle uv;
    Chart chart =
        square_chart(canvas, box, (double[2]){-0.02, -0.01}, (double[2]){0.66, 0.62}, UV_TITLES);
    draw_locus(&chart);
    for (int i = 0; i < 2; i++) {
        uv = standard_uv(i);
        draw_triangle(&chart, uv.at, (Stroke){canvas->theme.soft, 0.9, i ? DASH_SHORT : DASH_DOT});
    }
    if (panel_triangle(s, &uv)) {
        draw_triangle(&chart, uv.at, (Stroke){canvas->theme.ink, 1.7, DASH_NONE});
        for (int p = 1; p < 4; p++) draw_paths(&chart, s, (Pattern)p, canvas->theme.primary[p - 1]);
    }
    draw_paths(&chart, s, PATTERN_WHITE, canvas->theme.ink);
    static const struct {
        const char *name;
        Dash dash;
        double width;
    } KEYS[] = {{"this panel", DASH_NONE, 1.7},
                {"DCI-P3", DASH_SHORT, 0.9},
                {"sRGB, BT.709", DASH_DOT, 0.9}};
    double x = chart.plot.x + chart.plot.w - 108, y = chart.plot.y + chart.plot.h - 48;
    for (int i = s->is_white_only; i < 3; i++, y += 15) {
        Ink ink = i ? canvas->theme.soft : canvas->theme.ink;
        canvas_line(canvas, x, y, x + 24, y, (Stroke){ink, KEYS[i].width, KEYS[i].dash});
        canvas_text(canvas, x + 31, y,
                    (Letters){.size = SIZE_TICK, .ink = canvas->theme.ink, .down = 0.5},
                    KEYS[i].name);
    }
    panel_chart_map_axes(out, &chart);
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
            draw_chromaticity, s, 0, SHEET_ALWAYS, false});
}

/* ---- the white point over angle --------------------------------------------------------- */

static void draw_steps(Chart *chart, const double at[2], double step) {
    Canvas *canvas = chart->canvas;
    cairo_save(canvas->cr);
    cairo_rectangle(canvas->cr, chart->plot.x, chart->plot.y, chart->plot.w, chart->plot.h);
    cairo_clip(canvas->cr);
    for (int k = 1; k <= 12; k++) {
        char text[32];
        double r = chart_x(chart, at[0] + k * step) - chart_x(chart, at[0]);
        canvas_circle(canvas, chart_x(chart, at[0]), chart_y(chart, at[1]), r);
        canvas_stroke(canvas, (Stroke){canvas->theme.faint, 0.7, DASH_SHORT});
        canvas_text(canvas, chart_x(chart, at[0]) - 0.7071 * r, chart_y(chart, at[1]) - 0.7071 * r,
                    (Letters){.size = 7.5,
                              .ink = canvas->theme.soft,
                              .across = 0.5,
                              .down = 0.5,
                              .halo = canvas->theme.paper},
                    tick_text(k * step, step, text));
    }
    cairo_restore(canvas->cr);
}

static Ink azimuth_ink(const Canvas *canvas, int k) {
    double t = 0.05 + 0.8 * k / 3.0;
    return panel_chart_ink(MAP_AMOUNT, canvas->theme.is_dark ? 1 - 0.85 * t : 0.9 * t);
}

static void draw_white_point(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    static const char *const NAMES[] = {"φ 0°", "φ 90°", "φ 180°", "φ 270°"};
    double u[4][81], v[4][81], reach = 0.004;
    int count[4];
    PanelColour normal = plot_data_normal(s, PATTERN_WHITE);
    const double *at = normal.uv;
    for (int k = 0; k < 4; k++) {
        count[k] = angle_path(s, PATTERN_WHITE, k * PI / 2, u[k], v[k]);
        for (int i = 0; i < count[k]; i++)
            reach = fmax(reach, fmax(fabs(u[k][i] - at[0]), fabs(v[k][i] - at[1])));
    }
    reach *= 1.15;
    Chart chart = square_chart(canvas, box, (double[2]){at[0] - reach, at[1] - reach},
                               (double[2]){at[0] + reach, at[1] + reach}, UV_TITLES);
    draw_steps(&chart, at,
               reach > 0.12    ? 0.05
               : reach > 0.06  ? 0.02
               : reach > 0.025 ? 0.01
               : reach > 0.012 ? 0.005
                               : 0.002);
    for (int k = 3; k >= 0; k--) {
        Ink ink = azimuth_ink(canvas, k);
        chart_curve(&chart, u[k], v[k], count[k], (Stroke){ink, 1.6, (Dash)(k % 4)});
        for (int i = 15; i < count[k]; i += 15) chart_dot(&chart, u[k][i], v[k][i], 2.2, ink);
    }
    for (int k = 0; k < 4; k++) { /* a key: the paths often lie on each other */
        double x = chart.plot.x + 10, y = chart.plot.y + chart.plot.h - 52 + 14 * k;
        canvas_line(canvas, x, y, x + 22, y, (Stroke){azimuth_ink(canvas, k), 1.6, (Dash)k});
        canvas_text(canvas, x + 28, y,
                    (Letters){.size = SIZE_TICK,
                              .ink = canvas->theme.ink,
                              .down = 0.5,
                              .halo = canvas->theme.paper},
                    NAMES[k]);
    }
    chart_dot(&chart, at[0], at[1], 3, canvas->theme.ink);
    panel_chart_map_axes(out, &chart);
}

/* ---- spectra ---------------------------------------------------------------------------- */

#define SPECTRUM_POINTS 401 /* 380 to 780 nm */

typedef struct PrimarySpectrum {
    double nm[SPECTRUM_POINTS], value[SPECTRUM_POINTS], peak_nm, peak;
} PrimarySpectrum;

static void fill_spectrum(const PlotData *s, Pattern pattern, PrimarySpectrum *out) {
    float rgb[3];
    pattern_codes(pattern, rgb);
    for (int first = 0; first < SPECTRUM_POINTS; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = {0};
        for (int i = 0; i < SPECTRUM_LANES; i++)
            wavelengths.nm[i] = (float)fmin(380 + first + i, 780);
        Spectrum value = panel_emission_spectrum(s->source.panel, vec3(0, 0, 1), rgb, &wavelengths);
        for (int i = 0; i < SPECTRUM_LANES && first + i < SPECTRUM_POINTS; i++) {
            out->nm[first + i] = 380 + first + i;
            out->value[first + i] = (double)value[i];
        }
    }
    for (int i = 0; i < SPECTRUM_POINTS; i++) {
        if (out->value[i] <= out->peak) continue;
        out->peak = out->value[i];
        out->peak_nm = out->nm[i];
    }
}

static void fill_under(const Chart *chart, const PrimarySpectrum *spectrum, Ink ink) {
    cairo_t *cr = chart->canvas->cr;
    cairo_move_to(cr, chart_x(chart, 380), chart_y(chart, 0));
    for (int i = 0; i < SPECTRUM_POINTS; i++)
        cairo_line_to(cr, chart_x(chart, spectrum->nm[i]), chart_y(chart, spectrum->value[i]));
    cairo_line_to(cr, chart_x(chart, 780), chart_y(chart, 0));
    canvas_fill(chart->canvas, ink_alpha(ink, 0.13));
}

static void draw_spectra(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    PrimarySpectrum *spectrum = ARENA_NEW(canvas->arena, PrimarySpectrum, 4);
    double high = 0;
    for (int p = 0; p < 4; p++) {
        fill_spectrum(s, (Pattern)p, &spectrum[p]);
        high = fmax(high, spectrum[p].peak);
    }
    int shift = (int)floor(log10(high) / 3) * 3; /* milli, micro: no row of zeros */
    double unit = pow(10, shift);
    for (int p = 0; p < 4; p++)
        for (int i = 0; i < SPECTRUM_POINTS; i++) spectrum[p].value[i] /= unit;
    Chart chart = chart_open(
        canvas, box, (AxisSpec){.low = 380, .high = 780, .step = 50, .title = "Wavelength, nm"},
        (AxisSpec){.high = high / unit * 1.12,
                   .title = shift == -3   ? "Spectral radiance, mW m⁻² sr⁻¹ nm⁻¹"
                            : shift == -6 ? "Spectral radiance, µW m⁻² sr⁻¹ nm⁻¹"
                            : shift == 0  ? "Spectral radiance, W m⁻² sr⁻¹ nm⁻¹"
                                          : "Spectral radiance"},
        14);
    for (int p = 1; p < 4; p++) fill_under(&chart, &spectrum[p], canvas->theme.primary[p - 1]);
    chart_curve(&chart, spectrum[0].nm, spectrum[0].value, SPECTRUM_POINTS,
                (Stroke){canvas->theme.ink, 0.9, DASH_DOT});
    for (int p = 1; p < 4; p++) {
        Ink ink = canvas->theme.primary[p - 1];
        double peak = spectrum[p].peak / unit;
        chart_curve(&chart, spectrum[p].nm, spectrum[p].value, SPECTRUM_POINTS,
                    (Stroke){ink, 1.6, DASH_NONE});
        canvas_text(canvas, chart_x(&chart, spectrum[p].peak_nm), chart_y(&chart, peak) - 7,
                    (Letters){.size = SIZE_TICK,
                              .ink = ink,
                              .across = 0.5,
                              .down = 1,
                              .halo = canvas->theme.paper},
                    arena_format(canvas->arena, "%s %.0f nm", pattern_name((Pattern)p),
                                 spectrum[p].peak_nm));
    }
    panel_chart_map_axes(out, &chart);
}

static void add_colour(PanelChartList *list, const PlotData *s) {
    if (!s->emits) return;
    add_chromaticity(list, s);
    panel_chart_add(
        list, &(PanelChart){
                  PLOT_CHROMATICITY, "White point over angle",
                  "dots every 15° of θ, rings of Δu′v′ around the normal",
                  "The chromaticity of full white from the normal to θ 80° along four azimuths.",
                  draw_white_point, s, 0, SHEET_ALWAYS, false});
    panel_chart_add(
        list,
        &(PanelChart){PLOT_SPECTRA, "Spectra at the normal",
                      "each primary at full drive; dotted: white",
                      "Spectral radiance at the normal of each primary at full drive and of white.",
                      draw_spectra, s, 0, SHEET_ALWAYS, true});
}

const PanelCharts colour_charts = {PLOT_CHROMATICITY, PLOT_SPECTRA, add_colour};
