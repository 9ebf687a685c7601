/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/panel_chart.h"

#include <math.h>

#include "base/units.h"

void panel_chart_add(PanelChartList *list, const PanelChart *chart) {
    if (list->count == PANEL_CHARTS_MAX) return;
    PanelChart *out = &list->chart[list->count++];
    *out = *chart;
    if (!chart->needs_primaries || !chart->data->is_white_only) return;
    out->role = SHEET_NEVER;
    out->subtitle = "assumed, not measured: the source is a table of white only";
}

ChartRows *panel_chart_rows(const PanelChart *chart, const Theme *theme, Arena *arena) {
    ChartRows *rows = ARENA_NEW(arena, ChartRows, 1);
    *rows = (ChartRows){.theme = theme, .arena = arena};
    chart->fill(chart, rows);
    return rows;
}

void panel_chart_draw(Canvas *canvas, Box box, const PanelChart *chart) {
    const Theme *theme = &canvas->theme;
    canvas_text(canvas, box.x, box.y,
                (Letters){.size = SIZE_TITLE, .ink = theme->ink, .is_bold = true},
                canvas_fit_text(canvas, SIZE_TITLE, true, box.w, chart->title));
    canvas_text(canvas, box.x, box.y + 17, (Letters){.size = SIZE_TICK, .ink = theme->soft},
                canvas_fit_text(canvas, SIZE_TICK, false, box.w, chart->subtitle));
    chart_rows_draw(canvas, (Box){box.x, box.y + 34, box.w, box.h - 34},
                    panel_chart_rows(chart, theme, canvas->arena));
}

/* ---- inks -------------------------------------------------------------------------------- */

Ink panel_chart_ink(ColourMap map, double t) {
    double srgb[3];
    colour_map_at(map, t, srgb);
    return (Ink){srgb[0], srgb[1], srgb[2], 1};
}

Ink panel_chart_series_ink(const Theme *theme, int i, int count) {
    double t = count > 1 ? (double)i / (count - 1) : 0;
    return panel_chart_ink(MAP_SCATTER, theme->is_dark ? 0.42 + 0.5 * t : 0.12 + 0.6 * t);
}

Ink panel_chart_pattern_ink(const Theme *theme, Pattern pattern) {
    if (pattern == PATTERN_WHITE) return theme->ink;
    return pattern == PATTERN_BLACK ? theme->soft : theme->primary[pattern - PATTERN_RED];
}

Dash panel_chart_pattern_dash(Pattern pattern) {
    static const Dash DASHES[] = {DASH_NONE, DASH_LONG, DASH_NONE, DASH_SHORT, DASH_DOT};
    return DASHES[pattern];
}

/* ---- parts of charts --------------------------------------------------------------------- */

void panel_chart_polar(ChartRows *out, Field field, PolarMap map) {
    Field *copy = ARENA_NEW(out->arena, Field, 1);
    *copy = field;
    out->kind = CHART_POLAR;
    out->polar = map;
    out->polar.field = copy;
}

void panel_chart_angles(ChartRows *out, const char *title, double cone) {
    double last = degrees_from_radians(cone);
    out->x = (AxisSpec){.low = -90, .high = 90, .step = 30, .suffix = "°", .title = title};
    chart_rows_hatch(out, -90, -last);
    chart_rows_hatch(out, last, 90);
}

void panel_chart_section_axis(ChartRows *out, const PlotData *data, bool is_vertical) {
    panel_chart_angles(out,
                       is_vertical ? "θ along φ 270° (down) to 90° (up)"
                                   : "θ along φ 180° (left) to 0° (right)",
                       data->cone);
}

ChartPoints panel_chart_section(const ChartRows *out, const PlotData *data, const float rgb[3],
                                bool is_vertical) {
    ChartPoints p = chart_rows_points(out, SECTION_POINTS);
    for (int i = 0; i < p.count; i++) {
        p.x[i] = -88 + i * 0.5;
        p.y[i] = panel_figure_luminance(data->source.panel, radians_from_degrees(p.x[i]),
                                        is_vertical ? PI / 2 : 0, rgb);
    }
    return p;
}
