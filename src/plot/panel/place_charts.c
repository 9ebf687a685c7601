/* SPDX-License-Identifier: Apache-2.0 */
/* Where: white and black over the active area with the nine points, and the directions in which
 * the file misses the samples. */
#include <math.h>

#include "base/units.h"
#include "panel/query/panel_place.h"
#include "plot/draw/ticks.h"
#include "plot/panel/plot_charts.h"

/* ---- over the active area ---------------------------------------------------------------- */

typedef struct AreaOf {
    const Panel *panel;
    const float *rgb;
} AreaOf;

static double area_at(const void *context, double u, double v) {
    const AreaOf *of = context;
    float xyz[3];
    panel_place_emission_xyz(of->panel, (float[2]){(float)u, (float)v}, vec3(0, 0, 1), of->rgb,
                             xyz);
    return (double)xyz[1];
}

/* As wide as the display where its size is known. */
static double ratio_of(const PlotData *s) {
    const json_t *size = json_object_get(s->report, "size_mm");
    double w = json_number_value(json_array_get(size, 0));
    double h = json_number_value(json_array_get(size, 1));
    return w > 0 && h > 0 ? w / h : 16.0 / 9;
}

#define EVEN_SHARE 0.005
#define EVEN_REACH 0.05 /* of an even map's colours about its value: rounding shows none */

static void add_area(PlotCharts *charts, const PlotData *s, Pattern pattern) {
    const AreaOf of = {s->panel, pattern_codes(pattern)};
    PanelEvenness e = panel_figure_evenness(s->panel, of.rgb);
    float spot[PANEL_EVENNESS_SPOTS][2], place[2];
    char text[4][32];
    int map[2], spots = panel_spots(s->panel, spot, map);
    Chart *chart = chart_new(
        CHART_AREA, arena_format(s->arena, "%s over the active area", pattern_name(pattern)), NULL,
        "cd/m²", s->arena);
    bool is_even = e.most - e.least <= EVEN_SHARE * e.most;
    chart_fill(chart, area_at, &of);
    chart->ratio = ratio_of(s);
    chart->y = (ChartAxis){.low = is_even ? e.mean * (1 - EVEN_REACH) : e.least,
                           .high = is_even ? e.mean * (1 + EVEN_REACH) : e.most};
    for (int i = 0; i < PANEL_NINE; i++) {
        panel_nine_place(i, place);
        chart->mark[chart->mark_count++] =
            (ChartMark){(double)place[0], (double)place[1], e.nine[i]};
    }
    for (int i = 0; i < spots; i++)
        chart->mark[chart->mark_count++] =
            (ChartMark){(double)spot[i][0], (double)spot[i][1], (double)NAN};
    chart->subtitle = arena_format(
        s->arena, "%snine points: least %s, most %s, mean %s cd/m², non-uniformity %s %%",
        is_even ? "nearly constant; " : "", figure_text(e.nine_least, text[0]),
        figure_text(e.nine_most, text[1]), figure_text(e.nine_mean, text[2]),
        figure_text(100 * panel_non_uniformity(e.nine_least, e.nine_most), text[3]));
    chart->caption =
        "Luminance along the local normal over the active area, as someone facing the display sees "
        "it. The numbers are those of the nine points, a tenth, a half and nine tenths of width "
        "and height; rings stand where the panel was measured.";
    plot_add(charts, chart);
}

/* ---- what the fit leaves ------------------------------------------------------------------ */

/* An emission table of the set, with its codes. */
typedef struct SetTable {
    const AngleTable *table;
    float rgb[3];
    double peak, most; /* luminance; the largest residual, percent */
} SetTable;

/* Fitted less measured luminance over the measured one, percent; over a fortieth of the table's
 * peak where the light is dimmer than that. NaN on the horizon. */
static double residual_percent(const PlotData *s, const SetTable *of, int row) {
    double theta = (double)of->table->theta[row], phi = (double)of->table->phi[row];
    double measured = (double)of->table->value[3 * row + 1];
    if (theta > PI / 2 - 1e-4 || !(of->peak > 0)) return NAN;
    return 100 * fabs(panel_figure_luminance(s->panel, theta, phi, of->rgb) - measured) /
           fmax(0.025 * of->peak, measured);
}

static void look_at(const PlotData *s, const AngleTable *table, int primary, double code,
                    SetTable *worst) {
    SetTable one = {.table = table};
    if (primary >= 0) one.rgb[primary] = (float)code;
    for (int i = 0; i < table->rows; i++)
        one.peak = fmax(one.peak, (double)table->value[3 * i + 1]);
    for (int i = 0; i < table->rows; i++)
        one.most = fmax(one.most, residual_percent(s, &one, i)); /* NaN counts as nothing */
    if (one.most > worst->most) *worst = one;
}

typedef struct FitMap {
    int rows;
    const Vec3 *at;
    const double *percent;
    double reach; /* cosine of how far a sample stands for a direction */
} FitMap;

/* Of the nearest sample. */
static double map_at(const void *context, double theta, double phi) {
    const FitMap *map = context;
    Vec3 d = panel_figure_direction(theta, phi);
    double best = map->reach, value = NAN;
    for (int i = 0; i < map->rows; i++) {
        double cosine = (double)vec3_dot(map->at[i], d);
        if (cosine <= best) continue;
        best = cosine;
        value = map->percent[i];
    }
    return value;
}

static void add_fit(PlotCharts *charts, const PlotData *s) {
    const Measurement *set = s->measured;
    SetTable worst = {.most = 0};
    char text[32];
    if (set->has_black) look_at(s, &set->black, -1, 0, &worst);
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++)
            look_at(s, &set->primary[p].table[i], p, set->primary[p].level[i], &worst);
    if (!worst.table) return;
    int rows = worst.table->rows;
    double *percent = ARENA_NEW(s->arena, double, rows);
    Vec3 *at = ARENA_NEW(s->arena, Vec3, rows);
    for (int i = 0; i < rows; i++) {
        at[i] = panel_figure_direction((double)worst.table->theta[i], (double)worst.table->phi[i]);
        percent[i] = residual_percent(s, &worst, i);
    }
    const FitMap map = {rows, at, percent, cos(1.3 * sqrt(2 * PI / rows))};
    Chart *chart = chart_new(CHART_POLAR, "Residual of the worst table", NULL, "%", s->arena);
    chart_fill(chart, map_at, &map);
    chart->measured[1] = degrees_from_radians(s->cone);
    chart->y.high = worst.most;
    chart->has_no_lines = true;
    chart->subtitle = arena_format(s->arena, "%s, luminance, at most %s %%", worst.table->name,
                                   figure_text(worst.most, text));
    chart->caption = "How far the file's luminance is from the measured one, in percent (to a "
                     "fortieth of the table's peak where that is more), of the table in which it "
                     "is largest, at the nearest sample.";
    plot_add(charts, chart);
}

static void add_all(PlotCharts *charts, const PlotData *data, PlotKind kind) {
    if (plot_wants(kind, PLOT_UNIFORMITY) && panel_varies(data->panel)) {
        add_area(charts, data, PATTERN_WHITE);
        if (data->has_black) add_area(charts, data, PATTERN_BLACK);
    }
    if (plot_wants(kind, PLOT_FIT) && data->measured) add_fit(charts, data);
}

PlotAdd *const place_charts = add_all;
