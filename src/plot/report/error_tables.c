/* SPDX-License-Identifier: Apache-2.0 */
/* How far the panel file is from what was measured: one figure, explained. */
#include "plot/report/error_tables.h"

#include <math.h>
#include <string.h>

typedef struct PartError {
    double most, squares, outliers, outlier_most;
    int tables;
    const char *worst;
} PartError;

/* Tables of the reflection are named "brdf ...". */
static PartError error_of(const json_t *tables, bool of_reflection) {
    PartError out = {.worst = ""};
    size_t i;
    const json_t *table;
    json_array_foreach(tables, i, table) {
        const char *name = json_string_value(json_object_get(table, "name"));
        if (!name || !strncmp(name, "brdf", 4) != of_reflection) continue;
        double most = json_number_value(json_object_get(table, "max_error"));
        double rms = json_number_value(json_object_get(table, "rms_error"));
        if (most >= out.most) out.most = most, out.worst = name;
        out.squares += rms * rms;
        out.outliers += json_number_value(json_object_get(table, "outliers"));
        out.outlier_most =
            fmax(out.outlier_most, json_number_value(json_object_get(table, "outliers_max_error")));
        out.tables++;
    }
    return out;
}

static void add_part(Report *report, ReportTable *table, const PlotData *s, bool of_reflection) {
    PartError e = error_of(json_object_get(s->source.report, "tables"), of_reflection);
    if (!e.tables) return;
    report_row(report, table);
    report_text(table, of_reflection ? "reflection" : "emission");
    report_fixed(report, table, e.tables, 0);
    report_figure(report, table, 100 * e.most);
    report_text(table, arena_printable(report->arena, e.worst));
    report_figure(report, table, 100 * sqrt(e.squares / e.tables));
    report_fixed(report, table, e.outliers, 0);
    report_figure(report, table, 100 * e.outlier_most);
}

void report_errors(Report *report, const PlotData *data) {
    const json_t *emission = json_object_get(data->source.report, "emission");
    double floor = json_number_value(json_object_get(emission, "error_floor"));
    const char *dim = floor > 0 ? arena_format(report->arena,
                                               ", or over %.3g %% of the "
                                               "table's largest value where it is less",
                                               100 * floor)
                                : "";
    ReportTable *table = report_add(
        report, "error", "Panel file against measurement",
        arena_format(
            report->arena,
            "The error of this page: the difference between the panel "
            "file, from which every figure here is made, and a measured value (X, Y and Z of "
            "emission, every wavelength of reflection), over the measured value%s. Largest: of "
            "all directions of all tables, the noise of the source included. RMS: root of the "
            "mean square over the tables of each table's own. Outliers, which the file does "
            "not follow, are not counted in either.",
            dim));
    static const ReportColumn COLUMNS[] = {{"part", "Part"},
                                           {"tables", "Tables"},
                                           {"largest_error_percent", "Largest error, %"},
                                           {"in_table", "in the table"},
                                           {"rms_error_percent", "RMS error, %"},
                                           {"outliers", "Outliers left out"},
                                           {"outliers_error_percent", "up to, %"}};
    for (size_t i = 0; i < sizeof COLUMNS / sizeof *COLUMNS; i++)
        report_column(table, COLUMNS[i].key, COLUMNS[i].title);
    for (int part = 0; part < 2; part++) add_part(report, table, data, part == 1);
}
