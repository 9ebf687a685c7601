/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/report_figures.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "page/page.h"
#include "plot/panel/sheet.h"

#define CHART_WIDTH 420
#define CHART_HEIGHT 344

/* ---- values of a figure at the pointer -------------------------------------------------- */

#define READ_ROWS 46    /* every 2 degrees of theta */
#define READ_COLUMNS 60 /* every 6 degrees of phi */

static void add_polar_values(Text *html, const PanelChartMap *map)
{
    const Field *field = &map->field;
    text_format(html, "{\"kind\":\"polar\",\"x\":%.2f,\"y\":%.2f,\"r\":%.2f,\"rim\":%g,"
                "\"rows\":%d,\"columns\":%d,\"unit\":\"", map->disc.x, map->disc.y,
                map->disc.radius, degrees_from_radians(field->theta_rim), READ_ROWS,
                READ_COLUMNS);
    escape_markup(html, map->unit);
    text_add(html, "\",\"v\":[");
    for (int i = 0; i < READ_ROWS; i++)
        for (int j = 0; j < READ_COLUMNS; j++) {
            double column, row;
            field_place(field, field->theta_rim * i / (READ_ROWS - 1),
                        2 * PI * j / READ_COLUMNS, &column, &row);
            double v = field_at(field, column, row);
            if (i + j > 0) text_add(html, ",");
            if (isfinite(v)) text_format(html, "%.4g", v);
            else text_add(html, "null");
        }
    text_add(html, "]}");
}

/* An axis's name without its unit and explanation. */
static const char *short_name(Arena *arena, const char *title)
{
    return arena_string(arena, title, strcspn(title, ",("));
}

static void add_chart_values(Text *html, const PanelChartMap *map, Arena *arena)
{
    text_format(html, "{\"kind\":\"chart\",\"x\":%.2f,\"y\":%.2f,\"w\":%.2f,\"h\":%.2f,"
                "\"low\":[%.9g,%.9g],\"high\":[%.9g,%.9g],\"log\":[%d,%d],\"names\":[\"",
                map->plot.x, map->plot.y, map->plot.w, map->plot.h, map->low[0], map->low[1],
                map->high[0], map->high[1], map->is_log[0], map->is_log[1]);
    escape_markup(html, short_name(arena, map->axis[0]));
    text_add(html, "\",\"");
    escape_markup(html, short_name(arena, map->axis[1]));
    text_add(html, "\"]}");
}

/* chart: the index-th of its list; a caption that the one before has is not repeated. */
static bool add_chart(Text *html, const PanelChart *chart, int index, bool is_dark,
                      Arena *arena, Error *err)
{
    PlotBytes   svg = {0};
    PanelChartMap   map = {0};
    SheetChartFrame frame = {CHART_WIDTH, CHART_HEIGHT, arena_format(arena, "f%d-", index),
                         is_dark};
    if (!sheet_chart_svg(chart, &frame, arena, &svg, &map, err)) return false;
    text_format(html, "<figure class=\"ground%s\"", is_dark ? " night" : "");
    if (map.kind != PANEL_CHART_PLAIN) text_add(html, " data-map='");
    if (map.kind == PANEL_CHART_POLAR) add_polar_values(html, &map);
    else if (map.kind == PANEL_CHART_AXES) add_chart_values(html, &map, arena);
    text_add(html, map.kind != PANEL_CHART_PLAIN ? "'>\n" : ">\n");
    page_element(html, "h3", chart->title);
    page_element(html, "p", chart->subtitle);
    text_add_bytes(html, svg.data, svg.size);
    text_add(html, "<div class=\"read\"></div>\n");
    if (index == 0 || strcmp(chart[-1].caption, chart->caption) != 0)
        page_element(html, "figcaption", chart->caption);
    text_add(html, "</figure>\n");
    return true;
}

/* ---- the figures under their headings --------------------------------------------------- */

static const struct { PlotKind first, last; const char *title; } CHAPTERS[] = {
    {PLOT_LUMINANCE, PLOT_COLOUR_SHIFT, "Luminance, contrast and colour over the hemisphere"},
    {PLOT_SECTIONS, PLOT_SECTIONS, "Sections"},
    {PLOT_GREY_INVERSION, PLOT_GREY_LEVELS, "Grey levels"},
    {PLOT_CHROMATICITY, PLOT_SPECTRA, "Colour"},
    {PLOT_BRDF, PLOT_MIRROR, "Reflection"},
    {PLOT_UNIFORMITY, PLOT_UNIFORMITY, "Over the active area"},
    {PLOT_FIT, PLOT_FIT, "Measured against fitted"}};

/* Charts of what was assumed and not measured are for panel plot. */
static bool is_in_chapter(const PanelChart *chart, int chapter)
{
    if (chart->needs_primaries && chart->data->is_white_only) return false;
    return chart->kind >= CHAPTERS[chapter].first && chart->kind <= CHAPTERS[chapter].last;
}

bool report_figures(Text *html, const PanelChartList *list, bool is_dark, Arena *arena,
                         Error *err)
{
    for (int chapter = 0; chapter < (int)(sizeof CHAPTERS / sizeof *CHAPTERS); chapter++) {
        bool is_open = false;
        for (int i = 0; i < list->count; i++) {
            if (!is_in_chapter(&list->chart[i], chapter)) continue;
            if (!is_open) {
                page_element(html, "h2", CHAPTERS[chapter].title);
                text_add(html, "<div class=\"figures\">\n");
            }
            is_open = true;
            if (!add_chart(html, &list->chart[i], i, is_dark, arena, err)) return false;
        }
        if (is_open) text_add(html, "</div>\n");
    }
    return true;
}
