/* SPDX-License-Identifier: Apache-2.0 */
/* sheet.h -- charts side by side on one page, as the bytes of an SVG or PNG picture.
 *
 * Units    points of the page; a PNG has pixels_per_point of them.
 * Memory   the arena's. Threads: one page at a time per arena.
 * Fails    with cairo's reason.
 */
#pragma once
#include "base/error.h"
#include "plot/panel/panel_chart.h"
#include "plot/draw/picture.h"

typedef struct SheetSpec {
    const PanelChartList *list;
    const PlotData *data;
    PlotKind kind;
    int width, height;    /* pixels; 0: chosen */
    bool is_dark, is_svg; /* else a PNG */
} SheetSpec;

/* The picture of a whole page with heading and legend. */
bool sheet_picture(const SheetSpec *spec, Arena *arena, PlotBytes *out, Error *err);

typedef struct SheetChartFrame {
    double width, height; /* points */
    const char *prefix;   /* of the drawing's ids */
    bool is_dark;
} SheetChartFrame;

/* One chart alone, without its title, to stand inside another document. */
bool sheet_chart_svg(const ChartRows *rows, const SheetChartFrame *frame, Arena *arena,
                     PlotBytes *out, ChartMap *map, Error *err);
