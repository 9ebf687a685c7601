/* SPDX-License-Identifier: Apache-2.0 */
/* Polar maps of what the panel emits: luminance, contrast, colour shift. */
#include <math.h>

#include "base/units.h"
#include "plot/draw/ticks.h"
#include "plot/panel/panel_chart.h"

static const char *at_angles(Arena *arena, double theta, double phi) {
    double degrees = degrees_from_radians(phi);
    if (theta < radians_from_degrees(0.75)) return "at the normal";
    return arena_format(arena, "at θ %.0f°, φ %.0f°", degrees_from_radians(theta),
                        degrees < -0.5 ? degrees + 360 : fabs(degrees));
}

/* Round levels inside (low, high), not so near the ends or the strong level that they show
 * nothing. */
static void choose_levels(PolarMap *map, double low, double high, int most) {
    Ticks ticks = ticks_linear(low, high, most);
    map->step = ticks.step;
    for (int i = 0; i < ticks.count; i++)
        if (ticks.value[i] > low + 0.02 * (high - low) &&
            ticks.value[i] < high - 0.005 * (high - low) &&
            !(fabs(ticks.value[i] - map->strong) < 0.045 * (high - low)))
            map->level[map->level_count++] = ticks.value[i];
    if (isfinite(map->strong)) map->level[map->level_count++] = map->strong;
}

/* The user's lines in place of ours, lettered as they were requested. */
static bool take_contours(Arena *arena, PolarMap *map, const PlotContours *wanted, double on_axis) {
    for (int i = 0; i < wanted->count; i++) {
        map->level[i] = plot_contours_level(wanted, i, on_axis);
        map->level_text[i] =
            arena_format(arena, wanted->is_percent[i] ? "%.6g %%" : "%.6g", wanted->value[i]);
    }
    map->level_count = wanted->count;
    return wanted->count > 0;
}

/* ---- luminance -------------------------------------------------------------------------- */

/* Within two percent everywhere: over all colours that would be a map of noise. */
static bool is_even(FieldRange range) {
    return range.high - range.low < 0.02 * range.high;
}

static void fill_luminance(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    FieldRange range = field_range(&s->xyz[shown->index][1], s->cone);
    double low = range.low > 0.6 * range.high ? range.low : 0;
    if (is_even(range)) low = 0.9 * range.low;
    PolarMap map = {.map = MAP_AMOUNT,
                    .low = low,
                    .high = range.high,
                    .strong = NAN,
                    .theta_measured = s->cone,
                    .unit = "cd/m²"};
    double normal = (double)s->normal[shown->index][1], half = 0.5 * normal;
    bool is_labelled = take_contours(out->arena, &map, &s->source.contours, normal);
    if (!is_labelled && shown->index != PATTERN_BLACK && range.low < half && half < range.high) {
        map.strong = half;
        map.strong_text = "½";
    }
    if (!is_labelled && !is_even(range)) choose_levels(&map, fmax(range.low, low), range.high, 8);
    panel_chart_polar(out, s->xyz[shown->index][1], map);
}

static void add_luminance(PanelChartList *list, const PlotData *s, Pattern pattern) {
    FieldRange range = field_range(&s->xyz[pattern][1], s->cone);
    char normal[32], high[32];
    if (!(range.high > 0)) return;
    double at_normal = (double)s->normal[pattern][1];
    const char *most =
        s->azimuths ? arena_format(s->arena, "; %s", s->azimuths)
        : range.high > 1.002 * at_normal
            ? arena_format(s->arena, ", at most %s %s", figure_text(range.high, high),
                           at_angles(s->arena, range.theta, range.phi))
            : "";
    const char *subtitle =
        arena_format(s->arena, "%s cd/m² at the normal%s%s", figure_text(at_normal, normal),
                     is_even(range) ? ", nearly constant" : "", most);
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_LUMINANCE, arena_format(s->arena, "Luminance, %s", pattern_word(pattern)),
            subtitle,
            "Luminance in cd/m² over the viewing hemisphere: θ from the normal outwards, "
            "φ counter-clockwise from the viewer's right. The strong ring, where there is one, is "
            "half the luminance of the normal.",
            fill_luminance, s, pattern, SHEET_ALWAYS, pattern != PATTERN_WHITE});
}

/* Beyond it black is next to nothing and high ratios are noise: they do not set the colours. */
#define GRAZING (80 * PI / 180)

/* ---- contrast --------------------------------------------------------------------------- */

static void fill_contrast(const PanelChart *shown, ChartRows *out) {
    static const double LEVELS[] = {2,    5,    10,   20,    50,    100,   200,   500,
                                    1000, 2000, 5000, 10000, 20000, 50000, 100000};
    const PlotData *s = shown->data;
    PlotLight light = ambient_light(s, shown->index);
    Field field = ambient_contrast_field(s, &light, out->arena);
    FieldRange range = field_range(&field, fmin(s->cone, GRAZING));
    range.low = fmin(range.low, field_range(&field, s->cone).low);
    PolarMap map = {.map = MAP_RATIO,
                    .is_log = true,
                    .strong = NAN,
                    .low = round_down(fmax(range.low, range.high / 1e5)),
                    .high = round_up(range.high),
                    .theta_measured = s->cone,
                    .unit = ": 1"};
    if (map.high < 2 * map.low) map.low = map.high / 2;
    bool is_labelled =
        take_contours(out->arena, &map, &s->source.contours, ambient_contrast(s, 0, 0, &light));
    for (int i = 0; i < 15 && !is_labelled; i++)
        if (LEVELS[i] > range.low && LEVELS[i] < range.high)
            map.level[map.level_count++] = LEVELS[i];
    panel_chart_polar(out, field, map);
}

/* index: of ambient_light. */
static void add_contrast(PanelChartList *list, const PlotData *s, int index) {
    PlotLight light = ambient_light(s, index);
    Field field = ambient_contrast_field(s, &light, s->arena);
    char text[2][32];
    const char *where = !index                    ? "white over black"
                        : light.directed_lux <= 0 ? "in even diffuse light"
                        : light.lux <= 0          ? "in directed light"
                                                  : "in even and directed light";
    const char *least = s->azimuths
                            ? arena_format(s->arena, "; %s", s->azimuths)
                            : arena_format(s->arena, ", at least %s",
                                           figure_text(field_range(&field, s->cone).low, text[0]));
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_CONTRAST,
            index ? arena_format(s->arena, "Contrast ratio, %s", ambient_text(&light, s->arena))
                  : "Contrast ratio",
            arena_format(s->arena, "%s: %s at the normal%s", where,
                         figure_text(ambient_contrast(s, 0, 0, &light), text[1]), least),
            index ? "Contrast in ambient light, " AMBIENT_FORMULA ". Logarithmic colours."
                  : "Luminance of white over that of black in a dark room, logarithmic colours.",
            fill_contrast, s, index, SHEET_ALWAYS, !index});
}

/* ---- colour shift ----------------------------------------------------------------------- */

static const double SHIFT_LEVELS[] = {0.002, 0.005, 0.01, 0.02, 0.04, 0.06,
                                      0.08,  0.1,   0.15, 0.2,  0.3};

static void fill_shift(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    Field field = plot_data_shift(s, (Pattern)shown->index, out->arena);
    FieldRange range = field_range(&field, s->cone);
    PolarMap map = {.map = MAP_DIFFERENCE,
                    .strong = NAN,
                    .high = fmax(range.high, 0.005),
                    .theta_measured = s->cone,
                    .unit = "Δu′v′"};
    for (int i = 0; i < 11; i++)
        if (SHIFT_LEVELS[i] < range.high && SHIFT_LEVELS[i] > range.high / 12)
            map.level[map.level_count++] = SHIFT_LEVELS[i];
    panel_chart_polar(out, field, map);
}

static void add_shift(PanelChartList *list, const PlotData *s, Pattern pattern) {
    Field field = plot_data_shift(s, pattern, s->arena);
    FieldRange range = field_range(&field, s->cone);
    char high[32];
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_COLOUR_SHIFT, arena_format(s->arena, "Colour shift, %s", pattern_word(pattern)),
            s->azimuths ? s->azimuths
                        : arena_format(s->arena, "Δu′v′ from the normal, at most %s %s",
                                       figure_text(range.high, high),
                                       at_angles(s->arena, range.theta, range.phi)),
            "Distance Δu′v′ in the CIE 1976 chromaticity plane between the colour at an angle and "
            "the colour at the normal.",
            fill_shift, s, pattern, pattern == PATTERN_WHITE ? SHEET_ALWAYS : SHEET_NEVER,
            pattern != PATTERN_WHITE});
}

static void add_emission(PanelChartList *list, const PlotData *s) {
    if (!s->emits) return;
    add_luminance(list, s, PATTERN_WHITE);
    for (int p = PATTERN_RED; p <= PATTERN_BLACK; p++) add_luminance(list, s, (Pattern)p);
    for (int i = s->has_black ? 0 : 1; i <= s->source.ambient.count; i++) add_contrast(list, s, i);
    add_shift(list, s, PATTERN_WHITE);
    for (int p = PATTERN_RED; p <= PATTERN_BLUE; p++) add_shift(list, s, (Pattern)p);
}

const PanelCharts emission_charts = {PLOT_LUMINANCE, PLOT_COLOUR_SHIFT, add_emission};
