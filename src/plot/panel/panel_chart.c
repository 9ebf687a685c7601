/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/panel_chart.h"

#include "plot/draw/chart.h"

void panel_chart_add(PanelChartList *list, const PanelChart *chart)
{
    if (list->count == PANEL_CHARTS_MAX) return;
    PanelChart *out = &list->chart[list->count++];
    *out = *chart;
    if (!chart->needs_primaries || !chart->data->is_white_only) return;
    out->role = SHEET_NEVER;
    out->subtitle = "assumed, not measured: the source is a table of white only";
}

void panel_chart_draw(Canvas *canvas, Box box, const PanelChart *chart, PanelChartMap *map)
{
    Theme *theme = &canvas->theme;
    *map = (PanelChartMap){0};
    canvas_text(canvas, box.x, box.y,
                (Letters){.size = SIZE_TITLE, .ink = theme->ink, .is_bold = true},
                canvas_fit_text(canvas, SIZE_TITLE, true, box.w, chart->title));
    canvas_text(canvas, box.x, box.y + 17,
                (Letters){.size = SIZE_TICK, .ink = theme->soft},
                canvas_fit_text(canvas, SIZE_TICK, false, box.w, chart->subtitle));
    chart->draw(canvas, (Box){box.x, box.y + 34, box.w, box.h - 34}, chart, map);
}

Ink panel_chart_series_ink(const Canvas *canvas, int i, int count)
{
    double srgb[3], t = count > 1 ? (double)i / (count - 1) : 0;
    colour_map_at(MAP_SCATTER, canvas->theme.is_dark ? 0.42 + 0.5 * t : 0.12 + 0.6 * t, srgb);
    return (Ink){srgb[0], srgb[1], srgb[2], 1};
}

void panel_chart_map_axes(PanelChartMap *map, const Chart *chart)
{
    *map = (PanelChartMap){.kind = PANEL_CHART_AXES, .plot = chart->plot,
                       .low = {chart->x.low, chart->y.low},
                       .high = {chart->x.high, chart->y.high},
                       .is_log = {chart->x.is_log, chart->y.is_log},
                       .axis = {chart->x.title, chart->y.title}};
}
