/* SPDX-License-Identifier: Apache-2.0 */
/* What sections show over logarithmic axes: luminance, contrast, every grey level; and the map
 * of grey inversion. */
#include <math.h>

#include "base/units.h"
#include "plot/draw/ticks.h"
#include "plot/panel/grey_inversion.h"
#include "plot/panel/panel_chart.h"

#define GREYS_MAX 10

/* A curve over the section with its name at its right end. */
static void add_curve(ChartRows *out, ChartPoints points, const char *name, Stroke stroke) {
    Series *curve = chart_rows_add(out, SERIES_CURVE, name, stroke, points);
    curve->label = name;
    curve->label_index = SECTION_AT(78);
}

/* A logarithmic axis of the decades that hold what is within the measured cone; 1e-5 of the
 * largest is the least. */
static void set_range(ChartRows *out, const PlotData *s, const char *title) {
    double low = INFINITY, high = 0;
    for (int k = 0; k < out->count; k++) {
        ChartPoints p = out->series[k].points;
        for (int i = 0; i < p.count; i++) {
            if (radians_from_degrees(fabs(p.x[i])) > s->cone || !(p.y[i] > 0)) continue;
            low = fmin(low, p.y[i]);
            high = fmax(high, p.y[i]);
        }
    }
    if (!(high > 0)) low = high = 1;
    out->y = axis_log(round_down(fmin(fmax(0.8 * low, 1e-5 * high), 0.1 * high)),
                      round_up(1.2 * high), title);
    out->right = 48;
}

/* ---- luminance and contrast -------------------------------------------------------------- */

static void fill_luminances(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    panel_chart_section_axis(out, s, shown->index & 1);
    for (int p = PATTERN_BLACK; p >= PATTERN_WHITE; p--) {
        float rgb[3];
        bool is_assumed = s->is_white_only && p != PATTERN_WHITE;
        if (is_assumed || !(s->normal[p][1] > 0)) continue;
        pattern_codes((Pattern)p, rgb);
        add_curve(out, panel_chart_section(out, s, rgb, shown->index & 1), pattern_name((Pattern)p),
                  (Stroke){panel_chart_pattern_ink(out->theme, (Pattern)p),
                           p == PATTERN_WHITE ? 1.9 : 1.4, panel_chart_pattern_dash((Pattern)p)});
    }
    set_range(out, s, "Luminance, cd/m²");
}

/* In the dark, and in the light that was requested. */
static void fill_contrasts(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    const PlotAmbient *ambient = &s->source.ambient;
    double plane = shown->index & 1 ? PI / 2 : 0;
    panel_chart_section_axis(out, s, shown->index & 1);
    for (int k = ambient->count; k >= (s->has_black ? 0 : 1); k--) {
        PlotLight light = ambient_light(s, k);
        ChartPoints p = panel_chart_section(out, s, PANEL_WHITE, shown->index & 1);
        for (int i = 0; i < p.count; i++)
            p.y[i] = ambient_contrast(s, radians_from_degrees(p.x[i]), plane, &light);
        add_curve(out, p, k ? arena_format(out->arena, "light %d", k) : "Dark",
                  (Stroke){panel_chart_series_ink(out->theme, k, ambient->count + 1), k ? 1.3 : 1.9,
                           k ? DASH_LONG : DASH_NONE});
    }
    set_range(out, s, "Contrast ratio, white over black");
}

/* ---- grey levels ------------------------------------------------------------------------- */

static void fill_greys(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    GreyLevels levels = grey_levels(s);
    int first = s->has_black ? 0 : 1, all = levels.count - first;
    int count = all < GREYS_MAX ? all : GREYS_MAX;
    panel_chart_section_axis(out, s, shown->index & 1);
    for (int k = count - 1; k >= 0; k--) {
        float code = (float)levels.code[first + (count > 1 ? k * (all - 1) / (count - 1) : 0)];
        add_curve(out, panel_chart_section(out, s, (float[3]){code, code, code}, shown->index & 1),
                  arena_format(out->arena, "%.4g", (double)code),
                  (Stroke){panel_chart_series_ink(out->theme, k, count), 1.4,
                           k % 2 ? DASH_LONG : DASH_NONE});
    }
    set_range(out, s, "Luminance of grey, cd/m²");
}

static void fill_inversion(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    GreyLevels levels = grey_levels(s);
    Field field = grey_inversion_field(s, &levels, out->arena);
    FieldRange range = field_range(&field, s->cone);
    PolarMap map = {.map = MAP_DIFFERENCE,
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
    panel_chart_polar(out, field, map);
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
                fill_inversion, s, 0, SHEET_ALWAYS, false});
    add_pair(list, s,
             &(PanelChart){
                 .kind = PLOT_GREY_LEVELS,
                 .subtitle = text,
                 .caption =
                     "Luminance of measured grey levels over the angle, logarithmic. Where two "
                     "curves cross, greys are inverted.",
                 .fill = fill_greys},
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
                      .fill = fill_luminances},
        "Luminance", SHEET_NEVER);
    if ((s->has_black && !s->is_white_only) || s->source.ambient.count)
        add_pair(
            list, s,
            &(PanelChart){.kind = PLOT_SECTIONS,
                          .subtitle = light_list(s),
                          .caption = "Contrast ratio over the angle from the normal, logarithmic.",
                          .fill = fill_contrasts},
            "Contrast ratio", SHEET_NEVER);
}

const PanelCharts angle_charts = {PLOT_GREY_INVERSION, PLOT_SECTIONS, add_angle};
