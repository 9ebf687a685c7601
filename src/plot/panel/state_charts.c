/* SPDX-License-Identifier: Apache-2.0 */
/* A display's states beside each other: white over the angle, and over the hemisphere. */
#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "plot/draw/ticks.h"
#include "plot/panel/panel_chart.h"

#define SIDE 181     /* grid of a map: 1 degree a step */
#define POINTS 353   /* -88 to 88 degrees, every half */
#define DARKEST 1e-4 /* of the brightest: an axis begins there, */
#define FAINTEST 1e-3 /* and a map's colours */

static double white_at(const Panel *panel, Vec3 d)
{
    const float white[3] = {255, 255, 255};
    float       xyz[3];
    panel_emission_xyz(panel, d, white, xyz);
    return (double)xyz[1];
}

static double at_normal(const PlotData *s, int state)
{
    return white_at(s->source.states[state].panel, vec3(0, 0, 1));
}

/* The last theta that every state was measured at. */
static double common_cone(const PlotData *s)
{
    double cone = PI / 2;
    for (int k = 0; k < s->source.state_count; k++)
        cone = fmin(cone, panel_info_emission_cone(s->source.states[k].panel));
    return cone;
}

/* ---- over the angle ---------------------------------------------------------------------- */

typedef struct StateCurve {
    double theta_deg[POINTS], value[POINTS];
} StateCurve;

static void fill_curve(const Panel *panel, double phi, StateCurve *out)
{
    for (int i = 0; i < POINTS; i++) {
        out->theta_deg[i] = -88 + 0.5 * i;
        double theta = radians_from_degrees(out->theta_deg[i]);
        out->value[i] = white_at(panel, vec3((float)(sin(theta) * cos(phi)),
                                             (float)(sin(theta) * sin(phi)),
                                             (float)cos(theta)));
    }
}

static void draw_curves(Chart *chart, const PlotData *s, const StateCurve *curve)
{
    int count = s->source.state_count;
    for (int k = 0; k < count; k++) {
        Ink ink = panel_chart_series_ink(chart->canvas, k, count);
        chart_curve(chart, curve[k].theta_deg, curve[k].value, POINTS,
                    (Stroke){ink, k ? 1.4 : 1.9, k % 2 ? DASH_LONG : DASH_NONE});
        chart_name_curve(chart, curve[k].theta_deg, curve[k].value, POINTS, ink,
                         s->source.states[k].name);
    }
}

/* index: 1 the vertical section. */
static void draw_sections(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out)
{
    const PlotData *s = shown->data;
    int         count = s->source.state_count;
    StateCurve *curve = ARENA_NEW(canvas->arena, StateCurve, count);
    double      high = 0, least = INFINITY;
    for (int k = 0; k < count; k++) {
        fill_curve(s->source.states[k].panel, shown->index ? PI / 2 : 0, &curve[k]);
        for (int i = 0; i < POINTS; i++) {
            high = fmax(high, curve[k].value[i]);
            least = fmin(least, curve[k].value[i]);
        }
    }
    Chart chart = chart_open(canvas, box,
        (AxisSpec){.low = -90, .high = 90, .step = 30, .suffix = "°",
                   .title = shown->index ? "θ along φ 270° (down) to 90° (up)"
                                         : "θ along φ 180° (left) to 0° (right)"},
        (AxisSpec){.low = fmax(least, high * DARKEST), .high = high * 1.5, .is_log = true,
                   .title = "Luminance of white, cd/m²"}, 66);
    panel_chart_hatch(&chart, common_cone(s));
    draw_curves(&chart, s, curve);
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

/* ---- over the hemisphere ----------------------------------------------------------------- */

static Field field_of(const Panel *panel, Arena *arena)
{
    Field field = field_new(SIDE, PI / 2, arena);
    for (int i = 0; i < SIDE * SIDE; i++)
        field.value[i] = (float)white_at(panel, field_direction(&field, i / SIDE, i % SIDE));
    return field;
}

/* index: which state. All have the colours and lines of the brightest. */
static void draw_map(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out)
{
    static const double LINES[] = {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.9};
    const PlotData *s = shown->data;
    const Panel    *panel = s->source.states[shown->index].panel;
    Field          *field = ARENA_NEW(canvas->arena, Field, 1);
    double          high = 0, cone = panel_info_emission_cone(panel);
    for (int k = 0; k < s->source.state_count; k++) high = fmax(high, at_normal(s, k));
    *field = field_of(panel, canvas->arena);
    FieldRange range = field_range(field, cone);
    PolarMap   map = {.field = field, .map = MAP_RATIO, .is_log = true, .strong = NAN,
                      .low = high * FAINTEST, .high = high, .is_cut = range.high > 1.001 * high,
                      .theta_measured = cone, .unit = "cd/m²"};
    for (int i = 0; i < COUNT_OF(LINES); i++) {
        if (!(LINES[i] * high > range.low && LINES[i] * high < range.high)) continue;
        map.level_text[map.level_count] = arena_format(canvas->arena, "%.3g %%",
                                                       100 * LINES[i]);
        map.level[map.level_count++] = LINES[i] * high;
    }
    panel_chart_polar(canvas, box, &map, out);
}

/* ---- the charts -------------------------------------------------------------------------- */

static void add_states(PanelChartList *list, const PlotData *s)
{
    static const char *const titles[] = {"States, horizontal section",
                                         "States, vertical section"};
    int count = s->source.state_count;
    if (!s->emits || !count) return;
    for (int k = 0; k < count; k++) {
        char text[32];
        panel_chart_add(list, &(PanelChart){PLOT_STATES,
            arena_format(s->arena, "White, %s", s->source.states[k].name),
            arena_format(s->arena, "%s cd/m² at the normal",
                         figure_text(at_normal(s, k), text)),
            "Luminance of full white over the viewing hemisphere in one state. All states have "
            "one logarithmic scale; lines are shares of the brightest normal.", draw_map, s, k,
            SHEET_NEVER, false});
    }
    for (int i = 0; i < COUNT_OF(titles); i++)
        panel_chart_add(list, &(PanelChart){PLOT_STATES, titles[i],
            arena_format(s->arena, "white in the %d states of the display", count),
            "Luminance of full white over the angle from the normal, a curve for each state of "
            "the display.", draw_sections, s, i, i ? SHEET_NEVER : SHEET_ALWAYS, false});
}

const PanelCharts state_charts = {PLOT_STATES, PLOT_STATES, add_states};
