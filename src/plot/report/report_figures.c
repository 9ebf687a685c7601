/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/report_figures.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/units.h"
#include "page/page.h"
#include "plot/panel/sheet.h"

#define CHART_WIDTH 420
#define CHART_HEIGHT 344

/* ---- values of a figure at the pointer -------------------------------------------------- */

#define READ_ROWS 46    /* every 2 degrees of theta */
#define READ_COLUMNS 60 /* every 6 degrees of phi */

static double read_field(const Field *field, int i, int j) {
    double column, row;
    field_place(field, field->theta_rim * i / (READ_ROWS - 1), 2 * PI * j / READ_COLUMNS, &column,
                &row);
    return field_at(field, column, row);
}

static void add_polar_values(Text *html, const ChartMap *map, const PolarMap *polar) {
    const Field *field = polar->field;
    text_format(html,
                "{\"kind\":\"polar\",\"x\":%.2f,\"y\":%.2f,\"r\":%.2f,\"rim\":%g,"
                "\"rows\":%d,\"columns\":%d,\"unit\":\"",
                map->disc.x, map->disc.y, map->disc.radius, degrees_from_radians(field->theta_rim),
                READ_ROWS, READ_COLUMNS);
    text_add(html, polar->unit);
    text_add(html, "\",\"v\":[");
    for (int i = 0; i < READ_ROWS; i++)
        for (int j = 0; j < READ_COLUMNS; j++) {
            double v = read_field(field, i, j);
            if (i + j > 0) text_add(html, ",");
            if (isfinite(v)) text_format(html, "%.4g", v);
            else text_add(html, "null");
        }
    text_add(html, "]}");
}

/* An axis's name without its unit and explanation. */
static const char *short_name(Arena *arena, const char *title) {
    return arena_string(arena, title, strcspn(title, ",("));
}

static void add_chart_values(Text *html, const ChartMap *map, const ChartRows *rows, Arena *arena) {
    text_format(html,
                "{\"kind\":\"chart\",\"x\":%.2f,\"y\":%.2f,\"w\":%.2f,\"h\":%.2f,"
                "\"low\":[%.9g,%.9g],\"high\":[%.9g,%.9g],\"log\":[%d,%d],\"names\":[\"",
                map->plot.x, map->plot.y, map->plot.w, map->plot.h, map->low[0], map->low[1],
                map->high[0], map->high[1], rows->x.is_log, rows->y.is_log);
    text_add(html, short_name(arena, rows->x.title));
    text_add(html, "\",\"");
    text_add(html, short_name(arena, rows->y.title));
    text_add(html, "\"]}");
}

/* chart: the index-th of its list; a caption that the one before has is not repeated. */
static bool add_chart(json_t *list, const PanelChart *chart, int index, bool is_dark, Arena scratch,
                      Error *err) {
    PlotBytes svg = {0};
    ChartMap map = {0};
    SheetChartFrame frame = {CHART_WIDTH, CHART_HEIGHT, arena_format(&scratch, "f%d-", index),
                             is_dark};
    const Theme theme = is_dark ? theme_dark() : theme_light();
    const ChartRows *rows = panel_chart_rows(chart, &theme, &scratch);
    if (!sheet_chart_svg(rows, &frame, &scratch, &svg, &map, err)) return false;
    Text values = {.arena = &scratch};
    json_t *to = page_add(list);
    bool is_told = index == 0 || strcmp(chart[-1].caption, chart->caption) != 0;
    if (map.kind == CHART_POLAR) add_polar_values(&values, &map, &rows->polar);
    else if (map.kind == CHART_AXES) add_chart_values(&values, &map, rows, &scratch);
    page_set(to, "map", values.data);
    page_set(to, "title", chart->title);
    page_set(to, "subtitle", chart->subtitle);
    page_set(to, "caption", is_told ? chart->caption : NULL);
    json_object_set_new(to, "drawing", json_stringn((const char *)svg.data, svg.size));
    return true;
}

/* ---- as a table -------------------------------------------------------------------------- */

static void add_numbers(Table *table, double a, double b, double value) {
    table_row(table);
    table_number(table, a);
    table_number(table, b);
    table_number(table, value);
}

static void add_series(Table *table, const Series *series) {
    for (int i = 0; series->name && i < series->points.count; i++) {
        table_row(table);
        table_text(table, series->name);
        table_number(table, series->points.x[i]);
        table_number(table, series->points.y[i]);
    }
}

Table *report_chart_table(const PanelChart *chart, Arena *arena) {
    static const char *const KEYS[][2] = {[CHART_PLAIN] = {"u", "v"},
                                          [CHART_POLAR] = {"theta_deg", "phi_deg"},
                                          [CHART_AXES] = {"of"}};
    const Theme theme = theme_light();
    const ChartRows *rows = panel_chart_rows(chart, &theme, arena);
    const Field *field = rows->polar.field;
    const CellMap *map = &rows->cells;
    Column *column = ARENA_NEW(arena, Column, 3);
    TableKind *kind = ARENA_NEW(arena, TableKind, 1);
    *kind = (TableKind){"chart", chart->title, column, 3};
    for (int c = 0; c < 2; c++) column[c].key = KEYS[rows->kind][c];
    column[2].key = arena_format(arena, "%s, %s", chart->title,
                                 rows->kind == CHART_POLAR ? rows->polar.unit : map->unit);
    if (rows->kind == CHART_AXES) column[1].key = rows->x.title, column[2].key = rows->y.title;
    Table *table = table_new(kind, arena);
    for (int k = 0; k < rows->count; k++) add_series(table, &rows->series[k]);
    for (int i = 0; rows->kind == CHART_POLAR && i < READ_ROWS * READ_COLUMNS; i++)
        add_numbers(table,
                    degrees_from_radians(field->theta_rim) * (i / READ_COLUMNS) / (READ_ROWS - 1),
                    360.0 / READ_COLUMNS * (i % READ_COLUMNS),
                    read_field(field, i / READ_COLUMNS, i % READ_COLUMNS));
    for (int i = 0; rows->kind == CHART_PLAIN && i < map->columns * map->rows; i++)
        add_numbers(table, (i % map->columns + 0.5) / map->columns,
                    (i / map->columns + 0.5) / map->rows, (double)map->value[i]);
    return table;
}

/* ---- the figures under their headings --------------------------------------------------- */

static const struct {
    PlotKind first, last;
    const char *title;
} CHAPTERS[] = {
    {PLOT_LUMINANCE, PLOT_COLOUR_SHIFT, "Luminance, contrast and colour over the hemisphere"},
    {PLOT_SECTIONS, PLOT_SECTIONS, "Sections"},
    {PLOT_GREY_INVERSION, PLOT_GREY_LEVELS, "Grey levels"},
    {PLOT_CHROMATICITY, PLOT_SPECTRA, "Colour"},
    {PLOT_BRDF, PLOT_MIRROR, "Reflection"},
    {PLOT_UNIFORMITY, PLOT_UNIFORMITY, "Over the active area"},
    {PLOT_HALO, PLOT_HALO, "Local dimming"},
    {PLOT_FIT, PLOT_FIT, "Measured against fitted"}};

bool report_has_chart(const PanelChart *chart) {
    return !chart->needs_primaries || !chart->data->is_white_only;
}

static bool is_in_chapter(const PanelChart *chart, int chapter) {
    return report_has_chart(chart) && chart->kind >= CHAPTERS[chapter].first &&
           chart->kind <= CHAPTERS[chapter].last;
}

bool report_figures(json_t *values, const PanelChartList *list, bool is_dark, Arena *arena,
                    Error *err) {
    json_t *chapters = json_array();
    json_object_set_new(values, "chapters", chapters);
    for (int chapter = 0; chapter < COUNT_OF(CHAPTERS); chapter++) {
        json_t *figures = json_array();
        bool ok = true;
        for (int i = 0; i < list->count && ok; i++)
            if (is_in_chapter(&list->chart[i], chapter))
                ok = add_chart(figures, &list->chart[i], i, is_dark, *arena, err);
        if (json_array_size(figures) > 0)
            json_array_append_new(chapters, json_pack("{s:s, s:O}", "title",
                                                      CHAPTERS[chapter].title, "figures", figures));
        json_decref(figures);
        if (!ok) return false;
    }
    return true;
}
