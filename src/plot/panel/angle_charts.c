/* SPDX-License-Identifier: Apache-2.0 */
/* What sections show over logarithmic axes: luminance, contrast, every grey level; and the map
 * of grey inversion. */
#include <math.h>

#include "base/units.h"
#include "plot/draw/ticks.h"
#include "plot/panel/grey_inversion.h"
#include "plot/panel/panel_chart.h"

#define POINTS 353 /* -88 to 88 degrees, every half */
#define CURVES_MAX 10

typedef struct AngleCurve {
    const char *name;
    Stroke stroke;
    double value[POINTS];
} AngleCurve;

/* What stands over one section. */
typedef struct AngleCurves {
    const char *title; /* of the axis */
    int count;
    const AngleCurve *curve;
} AngleCurves;

static double angle_deg(int i) {
    return -88 + 0.5 * i;
}

/* index: bit 0 is the vertical section. */
static double plane_of(const PanelChart *shown) {
    return shown->index & 1 ? PI / 2 : 0;
}

static double luminance_at(const PlotData *s, int i, double plane, const float rgb[3]) {
    return panel_figure_luminance(s->source.panel, radians_from_degrees(angle_deg(i)), plane, rgb);
}

/* Decades that hold what is within the measured cone; 1e-5 of the largest is the least. */
static void find_range(const PlotData *s, const AngleCurve *curve, int count, AxisSpec *y) {
    double low = INFINITY, high = 0;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < POINTS; i++) {
            double value = curve[k].value[i];
            bool is_seen = radians_from_degrees(fabs(angle_deg(i))) <= s->cone;
            if (!is_seen || !(value > 0)) continue;
            low = fmin(low, value);
            high = fmax(high, value);
        }
    if (!(high > 0)) low = high = 1;
    y->high = round_up(1.2 * high);
    y->low = round_down(fmin(fmax(0.8 * low, 1e-5 * high), 0.1 * high));
}

static void draw_curves(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out,
                        const AngleCurves *curves) {
    const AngleCurve *curve = curves->curve;
    int count = curves->count;
    AxisSpec y = {.is_log = true, .title = curves->title};
    double deg[POINTS];
    for (int i = 0; i < POINTS; i++) deg[i] = angle_deg(i);
    find_range(shown->data, curve, count, &y);
    Chart chart =
        chart_open(canvas, box,
                   (AxisSpec){.low = -90,
                              .high = 90,
                              .step = 30,
                              .suffix = "°",
                              .title = shown->index & 1 ? "θ along φ 270° (down) to 90° (up)"
                                                        : "θ along φ 180° (left) to 0° (right)"},
                   y, 48);
    panel_chart_hatch(&chart, shown->data->cone);
    for (int k = count - 1; k >= 0; k--) {
        chart_curve(&chart, deg, curve[k].value, POINTS, curve[k].stroke);
        chart_name(&chart, 78, curve[k].value[332], curve[k].stroke.ink, curve[k].name);
    }
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

/* ---- luminance and contrast -------------------------------------------------------------- */

static void draw_luminances(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    static const Dash DASHES[] = {DASH_NONE, DASH_LONG, DASH_NONE, DASH_SHORT, DASH_DOT};
    const PlotData *s = shown->data;
    AngleCurve *curve = ARENA_NEW(canvas->arena, AngleCurve, PATTERN_COUNT);
    int count = 0;
    for (int p = 0; p < PATTERN_COUNT; p++) {
        bool is_primary = p != PATTERN_WHITE && p != PATTERN_BLACK;
        bool is_assumed = s->is_white_only && p != PATTERN_WHITE;
        if (is_assumed || !(s->normal[p][1] > 0)) continue;
        float rgb[3];
        Ink ink = is_primary           ? canvas->theme.primary[p - PATTERN_RED]
                  : p == PATTERN_WHITE ? canvas->theme.ink
                                       : canvas->theme.soft;
        pattern_codes((Pattern)p, rgb);
        curve[count].name = pattern_name((Pattern)p);
        curve[count].stroke = (Stroke){ink, p == PATTERN_WHITE ? 1.9 : 1.4, DASHES[p]};
        for (int i = 0; i < POINTS; i++)
            curve[count].value[i] = luminance_at(s, i, plane_of(shown), rgb);
        count++;
    }
    draw_curves(canvas, box, shown, out, &(AngleCurves){"Luminance, cd/m²", count, curve});
}

/* In the dark, and in the light that was requested. */
static void draw_contrasts(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    const PlotAmbient *ambient = &s->source.ambient;
    AngleCurve *curve = ARENA_NEW(canvas->arena, AngleCurve, 1 + PLOT_AMBIENT_MAX);
    int count = 0;
    for (int k = s->has_black ? 0 : 1; k <= ambient->count; k++, count++) {
        PlotLight dark = {0}, light = k ? ambient->light[k - 1] : dark;
        curve[count].name = k ? arena_format(canvas->arena, "light %d", k) : "Dark";
        curve[count].stroke = (Stroke){panel_chart_series_ink(canvas, k, ambient->count + 1),
                                       k ? 1.3 : 1.9, k ? DASH_LONG : DASH_NONE};
        for (int i = 0; i < POINTS; i++)
            curve[count].value[i] =
                ambient_contrast(s, radians_from_degrees(angle_deg(i)), plane_of(shown), &light);
    }
    draw_curves(canvas, box, shown, out,
                &(AngleCurves){"Contrast ratio, white over black", count, curve});
}

/* ---- grey levels ------------------------------------------------------------------------- */

static void draw_greys(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    GreyLevels levels = grey_levels(s);
    AngleCurve *curve = ARENA_NEW(canvas->arena, AngleCurve, CURVES_MAX);
    int first = s->has_black ? 0 : 1, all = levels.count - first;
    int count = all < CURVES_MAX ? all : CURVES_MAX;
    for (int k = 0; k < count; k++) {
        float code = (float)levels.code[first + (count > 1 ? k * (all - 1) / (count - 1) : 0)];
        curve[k].name = arena_format(canvas->arena, "%.4g", (double)code);
        curve[k].stroke =
            (Stroke){panel_chart_series_ink(canvas, k, count), 1.4, k % 2 ? DASH_LONG : DASH_NONE};
        for (int i = 0; i < POINTS; i++)
            curve[k].value[i] = luminance_at(s, i, plane_of(shown), (float[3]){code, code, code});
    }
    draw_curves(canvas, box, shown, out, &(AngleCurves){"Luminance of grey, cd/m²", count, curve});
}

static void draw_inversion(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    Field *field = ARENA_NEW(canvas->arena, Field, 1);
    GreyLevels levels = grey_levels(s);
    *field = grey_inversion_field(s, &levels, canvas->arena);
    FieldRange range = field_range(field, s->cone);
    PolarMap map = {.field = field,
                    .map = MAP_DIFFERENCE,
                    .strong = NAN,
                    .high = fmax(range.high, 5),
                    .theta_measured = s->cone,
                    .unit = "%"};
    Ticks ticks = ticks_linear(0, map.high, 5);
    map.step = ticks.step;
    map.level[map.level_count] = 100 * GREY_INVERSION_LEAST;
    map.level_text[map.level_count++] = "1";
    for (int i = 0; i < ticks.count; i++)
        if (ticks.value[i] > 2 && ticks.value[i] < 0.97 * map.high)
            map.level[map.level_count++] = ticks.value[i];
    panel_chart_polar(canvas, box, &map, out);
}

/* ---- the charts -------------------------------------------------------------------------- */

static void add_pair(PanelChartList *list, const PlotData *s, const PanelChart *chart,
                     const char *name, SheetRole vertical) {
    for (int i = 0; i < 2; i++) {
        PanelChart one = *chart;
        one.data = s;
        one.index = i;
        one.role = i ? vertical : SHEET_NEVER;
        one.title = arena_format(s->arena, "%s, %s section", name, i ? "vertical" : "horizontal");
        panel_chart_add(list, &one);
    }
}

static void add_greys(PanelChartList *list, const PlotData *s) {
    GreyLevels levels = grey_levels(s);
    if (levels.count == 0) return;
    GreyInversion most = grey_inversion_most(s, &levels);
    const char *text =
        most.share > 0
            ? arena_format(s->arena, "largest %.3g %%: level %.4g over %.4g at θ %.3g°, φ %.3g°",
                           100 * most.share, most.low, most.high, degrees_from_radians(most.theta),
                           degrees_from_radians(most.phi))
            : "no level is brighter than a higher one by 1 % or more";
    if (most.share > 0)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_GREY_INVERSION, "Grey inversion", text,
                "By how much a higher grey level gives less light than a lower one, percent of the "
                "lower one's luminance: of all pairs of measured levels the worst. White: none.",
                draw_inversion, s, 0, SHEET_ALWAYS, false});
    add_pair(list, s,
             &(PanelChart){
                 .kind = PLOT_GREY_LEVELS,
                 .subtitle = text,
                 .caption =
                     "Luminance of measured grey levels over the angle, logarithmic. Where two "
                     "curves cross, greys are inverted.",
                 .draw = draw_greys},
             "Grey levels", most.share > 0 ? SHEET_ALWAYS : SHEET_NEVER);
}

static const char *light_list(const PlotData *s) {
    const char *text = "white over black, in the dark";
    for (int i = 0; i < s->source.ambient.count; i++)
        text = arena_format(s->arena, "%s; light %d: %s", text, i + 1,
                            ambient_text(&s->source.ambient.light[i], s->arena));
    return text;
}

static void add_angle(PanelChartList *list, const PlotData *s) {
    if (!s->emits) return;
    add_greys(list, s);
    add_pair(
        list, s,
        &(PanelChart){.kind = PLOT_SECTIONS,
                      .subtitle = "logarithmic",
                      .caption = "Luminance in cd/m² over the angle from the normal, logarithmic.",
                      .draw = draw_luminances},
        "Luminance", SHEET_NEVER);
    if ((s->has_black && !s->is_white_only) || s->source.ambient.count)
        add_pair(
            list, s,
            &(PanelChart){.kind = PLOT_SECTIONS,
                          .subtitle = light_list(s),
                          .caption = "Contrast ratio over the angle from the normal, logarithmic.",
                          .draw = draw_contrasts},
            "Contrast ratio", SHEET_NEVER);
}

const PanelCharts angle_charts = {PLOT_GREY_INVERSION, PLOT_SECTIONS, add_angle};
