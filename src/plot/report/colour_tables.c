/* SPDX-License-Identifier: Apache-2.0 */
/* Primaries and gamut. */
#include "plot/report/colour_tables.h"

#include <math.h>

#include "spectrum/gamut.h"

static GamutTriangle own_triangle(const PlotData *s) {
    GamutTriangle out;
    for (int p = 0; p < 3; p++) {
        const float *xyz = s->normal[PATTERN_RED + p];
        double sum = (double)xyz[0] + (double)xyz[1] + (double)xyz[2];
        for (int c = 0; c < 2; c++) out.at[p][c] = (double)xyz[c] / sum;
    }
    return out;
}

static void add_primaries(Report *report, const PlotData *s, const GamutTriangle *xy) {
    GamutTriangle uv = gamut_in_uv(xy);
    ReportTable *table = report_add(report, "primaries", "Primaries",
                                    "At the normal, each alone at full drive, black included.");
    report_column(table, "primary", "Primary");
    report_column(table, "luminance_cd_m2", "L, cd/m²");
    report_column(table, "x", "x");
    report_column(table, "y", "y");
    report_column(table, "u", "u′");
    report_column(table, "v", "v′");
    for (int p = 0; p < 3; p++) {
        report_row(report, table);
        report_text(table, pattern_name((Pattern)(PATTERN_RED + p)));
        report_figure(report, table, (double)s->normal[PATTERN_RED + p][1]);
        for (int c = 0; c < 2; c++) report_fixed(report, table, xy->at[p][c], 4);
        for (int c = 0; c < 2; c++) report_fixed(report, table, uv.at[p][c], 4);
    }
}

static void add_gamut(Report *report, const GamutTriangle *xy) {
    GamutTriangle uv = gamut_in_uv(xy);
    ReportTable *table = report_add(
        report, "gamut", "Gamut",
        "Area: the triangle of the primaries over the standard's. Coverage: the share of the "
        "standard's triangle that lies inside. In CIE 1931 xy and in CIE 1976 u′v′; they "
        "differ, so state the plane with the figure.");
    report_column(table, "standard", "Standard");
    report_column(table, "area_xy_percent", "Area in xy, %");
    report_column(table, "coverage_xy_percent", "Coverage in xy, %");
    report_column(table, "area_uv_percent", "Area in u′v′, %");
    report_column(table, "coverage_uv_percent", "Coverage in u′v′, %");
    for (int i = 0; i < GAMUT_STANDARDS; i++) {
        GamutTriangle in_xy = gamut_triangle((GamutStandard)i), in_uv = gamut_in_uv(&in_xy);
        report_row(report, table);
        report_text(table, gamut_name((GamutStandard)i));
        report_fixed(report, table, 100 * gamut_area(xy, &in_xy), 1);
        report_fixed(report, table, 100 * gamut_coverage(xy, &in_xy), 1);
        report_fixed(report, table, 100 * gamut_area(&uv, &in_uv), 1);
        report_fixed(report, table, 100 * gamut_coverage(&uv, &in_uv), 1);
    }
}

void report_colour(Report *report, const PlotData *data) {
    if (!data->emits) return;
    if (data->is_white_only) {
        report_missing(report, "gamut", "Primaries and gamut",
                       "Only white was measured: the "
                       "panel's primaries are assumed, and no gamut is stated.");
        return;
    }
    GamutTriangle xy = own_triangle(data);
    add_primaries(report, data, &xy);
    add_gamut(report, &xy);
}
