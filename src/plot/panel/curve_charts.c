/* SPDX-License-Identifier: Apache-2.0 */
/* Luminance along two sections of the hemisphere, and over the grey levels. */
#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "plot/panel/panel_chart.h"

/* ---- sections --------------------------------------------------------------------------- */

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

/* Lines down from where white has half its luminance. */
static void add_halves(ChartRows *out, const PlotData *s, double phi, double half) {
    Ink ink = out->theme->accent;
    for (int side = -1; side <= 1; side += 2) {
        double deg = half_angle_deg(s, phi, side);
        if (isnan(deg)) continue;
        int outwards = fabs(deg) < 58 ? side : -side; /* where there is room */
        ChartPoints p = chart_rows_points(out, 2);
        p.x[0] = p.x[1] = deg;
        p.y[0] = half;
        chart_rows_add(out, SERIES_CURVE, NULL, (Stroke){ink, 0.9, DASH_SHORT}, p);
        p.count = 1;
        chart_rows_add(out, SERIES_DOTS, "half of white", (Stroke){ink, 2.6, DASH_NONE}, p);
        Series *word =
            chart_rows_word(out, deg, half, ink, arena_format(out->arena, "½ at %.1f°", fabs(deg)));
        word->dx = 5 * outwards;
        word->dy = outwards == side ? -2 : 10;
        word->across = outwards < 0;
    }
}

/* Above the curves' middle where they differ there, else at their right ends. index: bit 0 the
 * vertical section, bit 1 relative to the normal. */
static void fill_section(const PanelChart *shown, ChartRows *out) {
    static const Pattern ORDER[] = {PATTERN_WHITE, PATTERN_GREEN, PATTERN_RED, PATTERN_BLUE};
    const PlotData *s = shown->data;
    bool is_normalised = shown->index & 2;
    int count = s->is_white_only ? 1 : 4;
    double high = 0;
    panel_chart_section_axis(out, s, shown->index & 1);
    for (int p = count - 1; p >= 0; p--) {
        float rgb[3];
        pattern_codes((Pattern)p, rgb);
        ChartPoints points = panel_chart_section(out, s, rgb, shown->index & 1);
        for (int i = 0; i < points.count; i++) {
            if (is_normalised)
                points.y[i] /= s->normal[p][1] > 0 ? (double)s->normal[p][1] : (double)NAN;
            high = fmax(high, points.y[i]);
        }
        Series *curve = chart_rows_add(out, SERIES_CURVE, pattern_name((Pattern)p),
                                       (Stroke){panel_chart_pattern_ink(out->theme, (Pattern)p),
                                                p == PATTERN_WHITE ? 1.9 : 1.4,
                                                panel_chart_pattern_dash((Pattern)p)},
                                       points);
        curve->label = is_normalised ? curve->name : NULL;
        curve->label_index = SECTION_AT(70);
    }
    add_halves(out, s, shown->index & 1 ? PI / 2 : 0,
               is_normalised ? 0.5 : 0.5 * (double)s->normal[PATTERN_WHITE][1]);
    for (int i = 0; i < count && !is_normalised; i++) {
        double middle = (double)s->normal[ORDER[i]][1];
        if (!(middle > 0)) continue;
        Series *word = chart_rows_word(
            out, 0, middle, panel_chart_pattern_ink(out->theme, ORDER[i]), pattern_name(ORDER[i]));
        word->dy = -4;
        word->across = 0.5;
        word->crowd = CROWD_GOES_DOWN;
    }
    out->y = axis_even(0, high * 1.1,
                       is_normalised ? "Luminance over that at the normal" : "Luminance, cd/m²");
    out->right = is_normalised ? 48 : 14;
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
                fill_section, s, i, i < 2 ? SHEET_ALWAYS : SHEET_SPARE, false});
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

static Ink angle_ink(const Theme *theme, int i, int count) {
    double t = (i + 0.15) / count * 0.82;
    return panel_chart_ink(MAP_AMOUNT, theme->is_dark ? 1 - t : t);
}

enum { GREY_LINEAR, GREY_LOG, GREY_GAMMA };

static void grey_axes(int which, AxisSpec *x, AxisSpec *y) {
    *x = axis_log(8, 256, "Grey level, code of 255");
    *y = axis_log(3e-4, 1.2, "Luminance above black, relative to white");
    if (which == GREY_GAMMA) *y = axis_even(1, 3, "Local gamma, d log L / d log code");
    if (which != GREY_LINEAR) return;
    *x = (AxisSpec){.high = 255, .step = 51, .title = x->title};
    *y = axis_even(0, 1.02, y->title);
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

static void add_reference_gamma(ChartRows *out, int which) {
    ChartPoints p = chart_rows_points(out, GREY_POINTS);
    for (int i = 0; i < GREY_POINTS; i++) {
        p.x[i] = i + 1;
        p.y[i] = which == GREY_GAMMA ? 2.2 : pow(p.x[i] / 255, 2.2);
    }
    chart_rows_add(out, SERIES_CURVE, "γ 2.2", (Stroke){out->theme->faint, 1.2, DASH_DOT}, p);
    int at = which == GREY_LINEAR ? 215 : 11;
    if (which == GREY_GAMMA) return;
    Series *word = chart_rows_word(out, p.x[at], p.y[at], out->theme->soft, "γ 2.2");
    word->dx = 8;
    word->dy = 15;
}

/* The lowest code at which every primary was measured. */
static double first_level(const PlotData *s) {
    double first = 0, code[PANEL_INFO_LEVELS_MAX];
    for (int p = 0; p < 3; p++)
        if (panel_info_levels(s->source.panel, p, code) > 0) first = fmax(first, code[0]);
    return first;
}

/* Dots at the measured codes, on the curve of the normal. */
static void add_levels(ChartRows *out, const PlotData *s, const GreyCurve *normal) {
    ChartPoints p = chart_rows_points(out, PANEL_INFO_LEVELS_MAX);
    p.count = panel_info_levels(s->source.panel, 1, p.x);
    for (int i = 0; i < p.count; i++) {
        int at = (int)nearbyint(p.x[i]) - 1;
        bool is_on = at >= 0 && at < GREY_POINTS;
        p.x[i] = is_on ? normal->code[at] : 0;
        p.y[i] = is_on ? normal->relative[at] : NAN;
    }
    chart_rows_add(out, SERIES_DOTS, "measured",
                   (Stroke){angle_ink(out->theme, 0, ANGLES), 2, DASH_NONE}, p);
}

/* index: which. Names beside the curves of gamma, a key of the angles where they run too near
 * each other. */
static void fill_greys(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    bool is_gamma = shown->index == GREY_GAMMA;
    GreyCurve *curve = ARENA_NEW(out->arena, GreyCurve, CURVES);
    for (int k = 0; k < CURVES; k++)
        fill_grey(s, radians_from_degrees(GREY_ANGLES[k / PLANES]),
                  radians_from_degrees(GREY_PLANES[k % PLANES]), &curve[k]);
    out->right = is_gamma ? 62 : 14;
    grey_axes(shown->index, &out->x, &out->y);
    if (is_gamma) fit_gamma_axis(&out->y, curve, CURVES);
    if (shown->index != GREY_LINEAR) chart_rows_hatch(out, 0, first_level(s));
    add_reference_gamma(out, shown->index);
    for (int k = CURVES - 1; k >= 0; k--) {
        if (k > 0 && k < PLANES) continue; /* at the normal there is but one azimuth */
        const char *angle = arena_format(out->arena, "θ %d°", GREY_ANGLES[k / PLANES]);
        const char *name = k == 0 ? angle
                                  : arena_format(out->arena, "%d°, φ %d°", GREY_ANGLES[k / PLANES],
                                                 GREY_PLANES[k % PLANES]);
        Series *series =
            chart_rows_add(out, SERIES_CURVE, name,
                           (Stroke){angle_ink(out->theme, k / PLANES, ANGLES), k == 0 ? 1.9 : 1.3,
                                    GREY_DASHES[k % PLANES]},
                           (ChartPoints){GREY_POINTS, curve[k].code,
                                         is_gamma ? curve[k].gamma : curve[k].relative});
        series->is_key = !is_gamma && k % PLANES == 0;
        series->label = is_gamma ? name : series->is_key ? angle : NULL;
    }
    if (!is_gamma) add_levels(out, s, &curve[0]);
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
                                      CAPTIONS[i], fill_greys, s, i,
                                      i > 0 ? SHEET_ALWAYS : SHEET_SPARE, !s->has_gamma_table});
}

static void add_curve(PanelChartList *list, const PlotData *s) {
    if (!s->emits) return;
    add_sections(list, s);
    add_grey(list, s);
}

const PanelCharts curve_charts = {PLOT_GREY_LEVELS, PLOT_SECTIONS, add_curve};
