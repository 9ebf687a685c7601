/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/place_tables.h"

#include "panel/query/panel_place.h"

static void add_row(Report *report, ReportTable *table, const PlotData *s, Pattern pattern) {
    float rgb[3];
    pattern_codes(pattern, rgb);
    PanelEvenness e = panel_evenness(s->source.panel, rgb);
    report_row(report, table);
    report_text(table, pattern_name(pattern));
    for (int i = 0; i < PANEL_NINE; i++) report_figure(report, table, e.nine[i]);
    report_figure(report, table, e.nine_mean);
    report_fixed(report, table, 100 * panel_non_uniformity(e.nine_least, e.nine_most), 1);
}

void report_places(Report *report, const PlotData *data) {
    if (!data->emits) return;
    if (!panel_varies(data->source.panel)) {
        report_missing(report, "uniformity", "Over the active area",
                       "One place was measured: "
                       "how even the panel is, is not known.");
        return;
    }
    ReportTable *table = report_add(
        report, "uniformity", "Over the active area",
        "Luminance along the local normal, cd/m², at nine points, a tenth, a half and nine "
        "tenths of width and height, row by row from the upper left corner (SID, IDMS). "
        "Non-uniformity is 1 − least / most of the nine. All other tables are of the place "
        "where the file's own panel was measured.");
    report_column(table, "pattern", "Pattern");
    for (int i = 0; i < PANEL_NINE; i++) {
        char *key = arena_format(report->arena, "point_%d_cd_m2", i + 1);
        report_column(table, key, arena_format(report->arena, "%d", i + 1));
    }
    report_column(table, "mean_cd_m2", "Mean");
    report_column(table, "non_uniformity_percent", "Non-uniformity, %");
    add_row(report, table, data, PATTERN_WHITE);
    if (data->has_black) add_row(report, table, data, PATTERN_BLACK);
}
