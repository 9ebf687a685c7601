/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/panel_chart.h"

#include "base/units.h"

void panel_chart_add(PanelChartList *list, const PanelChart *chart) {
    if (list->count == PANEL_CHARTS_MAX) return;
    PanelChart *out = &list->chart[list->count++];
    *out = *chart;
    if (!chart->needs_primaries || !chart->data->is_white_only) return;
    out->role = SHEET_NEVER;
    out->subtitle = "assumed, not measured: the source is a table of white only";
}

void panel_chart_draw(Canvas *canvas, Box box, const PanelChart *chart, PanelChartMap *map) {
    Theme *theme = &canvas->theme;
    *map = (PanelChartMap){0};
    canvas_text(canvas, box.x, box.y,
                (Letters){.size = SIZE_TITLE, .ink = theme->ink, .is_bold = true},
                canvas_fit_text(canvas, SIZE_TITLE, true, box.w, chart->title));
    canvas_text(canvas, box.x, box.y + 17, (Letters){.size = SIZE_TICK, .ink = theme->soft},
                canvas_fit_text(canvas, SIZE_TICK, false, box.w, chart->subtitle));
    chart->draw(canvas, (Box){box.x, box.y + 34, box.w, box.h - 34}, chart, map);
}

Ink panel_chart_ink(ColourMap map, double t) {
    double srgb[3];
    colour_map_at(map, t, srgb);
    return (Ink){srgb[0], srgb[1], srgb[2], 1};
}

Ink panel_chart_series_ink(const Canvas *canvas, int i, int count) {
    double t = count > 1 ? (double)i / (count - 1) : 0;
    return panel_chart_ink(MAP_SCATTER, canvas->theme.is_dark ? 0.42 + 0.5 * t : 0.12 + 0.6 * t);
}

void panel_chart_polar(Canvas *canvas, Box box, const PolarMap *polar, PanelChartMap *map) {
    *map = (PanelChartMap){.kind = PANEL_CHART_POLAR,
                           .disc = polar_draw(canvas, box, polar),
                           .field = *polar->field,
                           .unit = polar->unit};
}

void panel_chart_hatch(Chart *chart, double cone) {
    chart_hatch(chart, -90, -degrees_from_radians(cone));
    chart_hatch(chart, degrees_from_radians(cone), 90);
}

void panel_chart_map_axes(PanelChartMap *map, const Chart *chart) {
    *map = (PanelChartMap){.kind = PANEL_CHART_AXES,
                           .plot = chart->plot,
                           .low = {chart->x.low, chart->y.low},
                           .high = {chart->x.high, chart->y.high},
                           .is_log = {chart->x.is_log, chart->y.is_log},
                           .axis = {chart->x.title, chart->y.title}};
}
