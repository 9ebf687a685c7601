/* SPDX-License-Identifier: Apache-2.0 */
/* Luminance along two sections of the hemisphere, and over the grey levels. */
#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "plot/panel/panel_chart.h"

/* ---- sections --------------------------------------------------------------------------- */

#define SECTION_POINTS 353 /* -88 to 88 degrees, every half */

typedef struct Section {
    double angle_deg[SECTION_POINTS], value[SECTION_POINTS];
} Section;

static void fill_section(const PlotData *s, Pattern pattern, double phi, bool is_normalised,
                         Section *out) {
    float rgb[3];
    double unit = is_normalised ? (double)s->normal[pattern][1] : 1;
    pattern_codes(pattern, rgb);
    for (int i = 0; i < SECTION_POINTS; i++) {
        out->angle_deg[i] = -88 + i * 0.5;
        double light = panel_figure_luminance(s->source.panel,
                                              radians_from_degrees(out->angle_deg[i]), phi, rgb);
        out->value[i] = unit > 0 ? light / unit : NAN;
    }
}

/* Where white falls below half of the normal's luminance, degrees; side -1: the opposite
 * azimuth, and below 0. NaN: not within the measured cone. */
static double half_angle_deg(const PlotData *s, double phi, int side) {
    return side * degrees_from_radians(panel_figure_viewing_angle(
                      s->source.panel, NULL, (PanelLimit){PANEL_LEAST_LUMINANCE, 0.5},
                      side < 0 ? phi + PI : phi));
}

static const char *half_angles_text(const PlotData *s, double phi) {
    double low = half_angle_deg(s, phi, -1);
    double high = half_angle_deg(s, phi, 1);
    double cone = degrees_from_radians(s->cone);
    if (isnan(low) && isnan(high))
        return arena_format(s->arena, "white keeps above half its luminance within ±%.3g°", cone);
    if (isnan(low) || isnan(high))
        return arena_format(s->arena, "half the luminance of white at %+.1f°",
                            isnan(low) ? high : low);
    return arena_format(s->arena, "half the luminance of white at −%.1f° and +%.1f°", -low, high);
}

static Ink pattern_ink(const Canvas *canvas, Pattern pattern) {
    if (pattern == PATTERN_WHITE) return canvas->theme.ink;
    if (pattern == PATTERN_BLACK) return canvas->theme.soft;
    return canvas->theme.primary[pattern - PATTERN_RED];
}

/* The curves differ without colour too. */
static Dash pattern_dash(Pattern pattern) {
    static const Dash DASHES[] = {DASH_NONE, DASH_LONG, DASH_NONE, DASH_SHORT, DASH_DOT};
    return DASHES[pattern];
}

static void mark_half(Chart *chart, const PlotData *s, double phi, bool is_normalised) {
    double half = is_normalised ? 0.5 : 0.5 * (double)s->normal[PATTERN_WHITE][1];
    Ink ink = chart->canvas->theme.accent;
    for (int side = -1; side <= 1; side += 2) {
        double deg = half_angle_deg(s, phi, side);
        if (isnan(deg)) continue;
        double x = chart_x(chart, deg), y = chart_y(chart, half);
        canvas_line(chart->canvas, x, y, x, chart->plot.y + chart->plot.h,
                    (Stroke){ink, 0.9, DASH_SHORT});
        chart_dot(chart, deg, half, 2.6, ink);
        int outwards = fabs(deg) < 58 ? side : -side; /* where there is room */
        canvas_text(chart->canvas, x + 5 * outwards, outwards == side ? y - 2 : y + 10,
                    (Letters){.size = SIZE_TICK,
                              .ink = ink,
                              .across = outwards < 0,
                              .down = 1,
                              .halo = chart->canvas->theme.paper},
                    arena_format(chart->canvas->arena, "½ at %.1f°", fabs(deg)));
    }
}

/* Above the curves' middle where they differ there, else at their right ends. */
static void name_sections(Chart *chart, const Section *section, int count, bool is_normalised) {
    static const int ORDER[] = {PATTERN_WHITE, PATTERN_GREEN, PATTERN_RED, PATTERN_BLUE};
    double last = -INFINITY;
    for (int i = 0; i < count; i++) {
        int p = ORDER[i];
        Ink ink = pattern_ink(chart->canvas, (Pattern)p);
        double middle = section[p].value[SECTION_POINTS / 2], y = chart_y(chart, middle) - 4;
        if (!isfinite(middle) || !(middle > 0)) continue;
        if (is_normalised) {
            chart_name(chart, 70, section[p].value[316], ink, pattern_name((Pattern)p));
            continue;
        }
        if (y < last + 12) y = last + 12;
        canvas_text(chart->canvas, chart_x(chart, 0), y,
                    (Letters){.size = SIZE_TICK,
                              .ink = ink,
                              .across = 0.5,
                              .down = 1,
                              .halo = chart->canvas->theme.paper},
                    pattern_name((Pattern)p));
        last = y;
    }
}

/* index: bit 0 the vertical section, bit 1 relative to the normal. */
static void draw_section(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    bool is_normalised = shown->index & 2;
    int count = s->is_white_only ? 1 : 4;
    double phi = shown->index & 1 ? PI / 2 : 0, high = 0;
    Section *section = ARENA_NEW(canvas->arena, Section, 4);
    for (int p = 0; p < count; p++) {
        fill_section(s, (Pattern)p, phi, is_normalised, &section[p]);
        for (int i = 0; i < SECTION_POINTS; i++) high = fmax(high, section[p].value[i]);
    }
    Chart chart =
        chart_open(canvas, box,
                   (AxisSpec){.low = -90,
                              .high = 90,
                              .step = 30,
                              .suffix = "°",
                              .title = shown->index & 1 ? "θ along φ 270° (down) to 90° (up)"
                                                        : "θ along φ 180° (left) to 0° (right)"},
                   (AxisSpec){.high = high * 1.1,
                              .title = is_normalised ? "Luminance over that at the normal"
                                                     : "Luminance, cd/m²"},
                   is_normalised ? 48 : 14);
    panel_chart_hatch(&chart, s->cone);
    for (int p = count - 1; p >= 0; p--) {
        Ink ink = pattern_ink(canvas, (Pattern)p);
        chart_curve(&chart, section[p].angle_deg, section[p].value, SECTION_POINTS,
                    (Stroke){ink, p == 0 ? 1.9 : 1.4, pattern_dash((Pattern)p)});
    }
    mark_half(&chart, s, phi, is_normalised);
    name_sections(&chart, section, count, is_normalised);
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

static void add_sections(PanelChartList *list, const PlotData *s) {
    static const char *const TITLES[] = {"Horizontal section", "Vertical section",
                                         "Horizontal section, normalised",
                                         "Vertical section, normalised"};
    for (int i = 0; i < 4; i++)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_SECTIONS, TITLES[i], half_angles_text(s, i & 1 ? PI / 2 : 0),
                i & 2 ? "Luminance over the angle from the normal, each pattern divided by its own "
                        "luminance at the normal."
                      : "Luminance in cd/m² over the angle from the normal, for full white and the "
                        "three primaries alone.",
                draw_section, s, i, i < 2 ? SHEET_ALWAYS : SHEET_SPARE, false});
}

/* ---- grey levels ------------------------------------------------------------------------ */

#define GREY_POINTS 255 /* codes 1 .. 255 */

typedef struct GreyCurve {
    double code[GREY_POINTS], relative[GREY_POINTS], gamma[GREY_POINTS];
} GreyCurve;

/* Luminance of grey above black over that of white above black; its slope over the logarithm of
 * the code across a twelfth of a decade. */
static void fill_grey(const PlotData *s, double theta, double phi, GreyCurve *out) {
    double black = panel_figure_luminance(s->source.panel, theta, phi, PANEL_BLACK);
    double white = panel_figure_luminance(s->source.panel, theta, phi, PANEL_WHITE);
    for (int i = 0; i < GREY_POINTS; i++) {
        float code = (float)(i + 1);
        double light =
            panel_figure_luminance(s->source.panel, theta, phi, (float[3]){code, code, code});
        out->code[i] = (double)code;
        out->relative[i] = (light - black) / (white - black);
    }
    for (int i = 0; i < GREY_POINTS; i++) {
        int a = (int)(i * 0.9), b = (int)fmin(GREY_POINTS - 1, i * 1.1 + 2);
        double low = out->relative[a], high = out->relative[b];
        out->gamma[i] = i >= 11 && low > 0 && high > 0
                            ? log(high / low) / log(out->code[b] / out->code[a])
                            : NAN;
    }
}

static const int GREY_ANGLES[] = {0, 15, 30, 45, 60};
static const int GREY_PLANES[] = {0, 90, 270};
static const Dash GREY_DASHES[] = {DASH_NONE, DASH_SHORT, DASH_DOT};
enum { ANGLES = COUNT_OF(GREY_ANGLES), PLANES = COUNT_OF(GREY_PLANES), CURVES = ANGLES * PLANES };

static Ink angle_ink(const Canvas *canvas, int i, int count) {
    double t = (i + 0.15) / count * 0.82;
    return panel_chart_ink(MAP_AMOUNT, canvas->theme.is_dark ? 1 - t : t);
}

enum { GREY_LINEAR, GREY_LOG, GREY_GAMMA };

static void grey_axes(int which, AxisSpec *x, AxisSpec *y) {
    *x = (AxisSpec){.high = 255, .step = 51, .title = "Grey level, code of 255"};
    *y = (AxisSpec){.high = 1.02, .title = "Luminance above black, relative to white"};
    if (which == GREY_LOG) {
        *x = (AxisSpec){.low = 8, .high = 256, .is_log = true, .title = x->title};
        *y = (AxisSpec){.low = 3e-4, .high = 1.2, .is_log = true, .title = y->title};
    } else if (which == GREY_GAMMA) {
        *x = (AxisSpec){.low = 8, .high = 256, .is_log = true, .title = x->title};
        *y = (AxisSpec){.low = 1, .high = 3, .title = "Local gamma, d log L / d log code"};
    }
}

/* The smallest round range that holds the curves. */
static void fit_gamma_axis(AxisSpec *y, const GreyCurve *curve, int count) {
    double low = 1.8, high = 2.6;
    for (int k = 0; k < count; k++)
        for (int i = 12; i < GREY_POINTS; i++) {
            if (!isfinite(curve[k].gamma[i])) continue;
            low = fmin(low, floor(curve[k].gamma[i] * 5) / 5);
            high = fmax(high, ceil(curve[k].gamma[i] * 5) / 5);
        }
    y->low = fmax(low, -2); /* below 0 where greys are inverted */
    y->high = fmin(high, 6);
}

static void draw_reference_gamma(Chart *chart, int which) {
    double x[GREY_POINTS], y[GREY_POINTS];
    for (int i = 0; i < GREY_POINTS; i++) {
        x[i] = i + 1;
        y[i] = which == GREY_GAMMA ? 2.2 : pow(x[i] / 255, 2.2);
    }
    Ink ink = chart->canvas->theme.faint;
    chart_curve(chart, x, y, GREY_POINTS, (Stroke){ink, 1.2, DASH_DOT});
    if (which == GREY_GAMMA) return;
    int at = which == GREY_LINEAR ? 215 : 11;
    canvas_text(chart->canvas, chart_x(chart, x[at]) + (which == GREY_LINEAR ? 6 : 8),
                chart_y(chart, y[at]) + 4,
                (Letters){.size = SIZE_SMALL, .ink = chart->canvas->theme.soft}, "γ 2.2");
}

/* In the free upper left corner: the curves run too near each other for names of their own. */
static void write_angle_key(const Chart *chart) {
    Canvas *canvas = chart->canvas;
    double x = chart->plot.x + 14, y = chart->plot.y + 14;
    for (int i = 0; i < ANGLES; i++, y += 14) {
        Ink ink = angle_ink(canvas, i, ANGLES);
        canvas_line(canvas, x, y, x + 20, y, (Stroke){ink, 1.6, DASH_NONE});
        canvas_text(canvas, x + 27, y,
                    (Letters){.size = SIZE_TICK,
                              .ink = canvas->theme.ink,
                              .down = 0.5,
                              .halo = canvas->theme.paper},
                    arena_format(canvas->arena, "θ %d°", GREY_ANGLES[i]));
    }
}

/* The lowest code at which every primary was measured. */
static double first_level(const PlotData *s) {
    double first = 0, code[PANEL_INFO_LEVELS_MAX];
    for (int p = 0; p < 3; p++)
        if (panel_info_levels(s->source.panel, p, code) > 0) first = fmax(first, code[0]);
    return first;
}

/* Dots at the measured codes, on the curve of the normal. */
static void mark_levels(Chart *chart, const PlotData *s, const GreyCurve *normal) {
    double code[PANEL_INFO_LEVELS_MAX];
    int count = panel_info_levels(s->source.panel, 1, code);
    for (int i = 0; i < count; i++) {
        int at = (int)nearbyint(code[i]) - 1;
        if (at >= 0 && at < GREY_POINTS)
            chart_dot(chart, normal->code[at], normal->relative[at], 2,
                      angle_ink(chart->canvas, 0, ANGLES));
    }
}

static void draw_grey(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    GreyCurve *curve = ARENA_NEW(canvas->arena, GreyCurve, CURVES);
    AxisSpec x, y;
    for (int k = 0; k < CURVES; k++)
        fill_grey(s, radians_from_degrees(GREY_ANGLES[k / PLANES]),
                  radians_from_degrees(GREY_PLANES[k % PLANES]), &curve[k]);
    grey_axes(shown->index, &x, &y);
    if (shown->index == GREY_GAMMA) fit_gamma_axis(&y, curve, CURVES);
    Chart chart = chart_open(canvas, box, x, y, shown->index == GREY_GAMMA ? 62 : 14);
    double first = first_level(s);
    if (shown->index != GREY_LINEAR) chart_hatch(&chart, 0, first);
    draw_reference_gamma(&chart, shown->index);
    for (int k = CURVES - 1; k >= 0; k--) {
        if (k > 0 && k < PLANES) continue; /* at the normal there is but one azimuth */
        const double *values = shown->index == GREY_GAMMA ? curve[k].gamma : curve[k].relative;
        Ink ink = angle_ink(canvas, k / PLANES, ANGLES);
        chart_curve(&chart, curve[k].code, values, GREY_POINTS,
                    (Stroke){ink, k == 0 ? 1.9 : 1.3, GREY_DASHES[k % PLANES]});
        const char *name = k == 0 ? "θ 0°"
                                  : arena_format(canvas->arena, "%d°, φ %d°",
                                                 GREY_ANGLES[k / PLANES], GREY_PLANES[k % PLANES]);
        if (shown->index == GREY_GAMMA)
            chart_name_curve(&chart, curve[k].code, values, GREY_POINTS, ink, name);
    }
    if (shown->index != GREY_GAMMA) {
        mark_levels(&chart, s, &curve[0]);
        write_angle_key(&chart);
    }
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

static void add_grey(PanelChartList *list, const PlotData *s) {
    static const char *const TITLES[] = {"Grey levels", "Grey levels, logarithmic", "Local gamma"};
    static const char *const SUBTITLES[] = {
        "solid: φ 0° (right), dashed: 90° (up), dotted: 270° (down); dots: measured",
        "solid: φ 0° (right), dashed: 90° (up), dotted: 270° (down); dots: measured",
        "solid: φ 0° (right), dashed: 90° (up), dotted: 270° (down)"};
    static const char TABLE_SUBTITLE[] =
        "a gamma table of the normal, taken for every angle; dotted: 2.2";
    static const char *const CAPTIONS[] = {
        "Luminance of grey (red, green and blue at one code) above that of black, divided by "
        "that of white, at several angles. Thin dots: a power of 2.2.",
        "The same over logarithmic axes: a power law is a straight line. Hatched: below the "
        "first measured level.",
        "Slope of the logarithmic curves: the exponent that a small step of the code sees. "
        "Hatched: below the first measured level."};
    for (int i = 0; i < 3; i++)
        panel_chart_add(list,
                        &(PanelChart){PLOT_GREY_LEVELS, TITLES[i],
                                      s->has_gamma_table ? TABLE_SUBTITLE : SUBTITLES[i],
                                      CAPTIONS[i], draw_grey, s, i,
                                      i > 0 ? SHEET_ALWAYS : SHEET_SPARE, !s->has_gamma_table});
}

static void add_curve(PanelChartList *list, const PlotData *s) {
    if (!s->emits) return;
    add_sections(list, s);
    add_grey(list, s);
}

const PanelCharts curve_charts = {PLOT_GREY_LEVELS, PLOT_SECTIONS, add_curve};
