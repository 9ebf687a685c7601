/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/report.h"

#include <ctype.h>
#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "page/page.h"
#include "panel/set/set_writer.h"
#include "plot/report/file_report.h"
#include "text/json_text.h"

/* ---- what was measured, by whom, when ---------------------------------------------------- */

/* Degrees without the rounding of a cosine in the file. */
static json_t *degrees_json(bool is_there, double radians) {
    return is_there ? json_real(round(degrees_from_radians(radians) * 1e4) / 1e4) : json_null();
}

static json_t *facts_json(const PlotData *s) {
    static const char *const STATED[] = {
        "panel",  "instrument",       "date",   "operator", "conditions",
        "source", "source_hash_xxh3", "verdict"};
    json_t *out = json_object();
    for (int i = 0; i < COUNT_OF(STATED); i++) {
        const char *text = json_string_value(json_object_get(s->report, STATED[i]));
        json_object_set_new(
            out, STATED[i],
            json_text_or_null(text && *text ? arena_printable(s->arena, text) : NULL));
    }
    json_object_set_new(out, "file", json_text(s->file));
    json_object_set_new(out, "emission_to_theta_deg", degrees_json(s->emits, s->cone));
    json_object_set_new(out, "reflection_to_incidence_deg",
                        degrees_json(s->reflects, s->last_incidence));
    return out;
}

/* ---- the page ---------------------------------------------------------------------------- */

#define CHART_WIDTH 420
#define CHART_HEIGHT 344

static bool add_figures(json_t *to, const PlotCharts *charts, Arena scratch, Error *err) {
    json_t *figures = json_array();
    json_object_set_new(to, "figures", figures);
    for (int i = 0; i < charts->count; i++) {
        const Chart *chart = charts->chart[i];
        bool is_told = i > 0 && charts->chart[i - 1]->caption == chart->caption;
        PlotBytes svg = {0};
        if (!plot_chart_svg(chart, CHART_WIDTH, CHART_HEIGHT, &scratch, &svg, err)) return false;
        json_t *figure = page_add(figures);
        page_set(figure, "title", chart->title);
        page_set(figure, "subtitle", chart->subtitle);
        page_set(figure, "caption", is_told ? NULL : chart->caption);
        json_object_set_new(figure, "drawing", page_bytes("svg+xml", svg.data, svg.size, scratch));
    }
    return true;
}

static bool write_page(const PlotData *s, const PlotCharts *charts, const Report *report,
                       const ReportSpec *spec, Error *err) {
    json_t *to = facts_json(s), *tables = json_array(), *lines = json_array();
    int count;
    const TableLine *line = table_lines(spec->info_kind, spec->info, s->arena, &count);
    for (int i = 0; i < count; i++)
        json_array_append_new(lines, json_pack("{s:s, s:o}", "words", line[i].words, "value",
                                               json_text(line[i].value)));
    for (int i = 0; i < report->count; i++)
        json_array_append_new(tables, table_page(report->table[i]));
    const Table *sizes = panel_file_table(s->report, s->arena);
    page_set(to, "name", s->name);
    page_set(to, "file_name", s->file_name);
    json_object_set(to, "note", json_object_get(s->report, "note"));
    json_object_set_new(to, "lines", lines);
    json_object_set_new(to, "tables", tables);
    json_object_set_new(to, "sizes", sizes ? table_page(sizes) : json_null());
    if (page_set_head(to, s->name, "panel report", err) && add_figures(to, charts, *s->arena, err))
        return page_write_values("panel.html", to, NULL, spec->page, err);
    json_decref(to);
    return false;
}

/* ---- JSON and CSV ------------------------------------------------------------------------ */

static json_t *tables_json(const Report *report) {
    json_t *tables = json_array();
    for (int i = 0; i < report->count; i++) {
        const Table *table = report->table[i];
        json_array_append_new(
            tables, json_pack("{s:s, s:s, s:o, s:o, s:o}", "name", table->kind->key, "title",
                              table->kind->words, "note", json_text(table->note), "missing",
                              json_text_or_null(table->missing), "rows", table_json(table)));
    }
    return tables;
}

/* "chart_07_grey_levels.csv" */
static const char *chart_file(const Chart *chart, int index, Arena *arena) {
    char *name = arena_format(arena, "chart_%02d_%s.csv", index + 1, chart->title);
    for (char *c = name; c[4]; c++)
        *c = isalnum((unsigned char)*c) ? (char)tolower((unsigned char)*c) : '_';
    return name;
}

static bool add_csv(SetWriter *writer, const char *name, const Table *table, Arena scratch) {
    Text csv = {.arena = &scratch};
    table_add_csv(table, &csv);
    return set_writer_add(writer, name, &csv);
}

/* KEY.csv of every table that is there, the rows of every chart, and report.json with `answer`,
 * into a folder: all or none, and none of them in the place of the panel. */
static bool write_csv(const Report *report, const PlotCharts *charts, const json_t *answer,
                      const ReportSpec *spec, Error *err) {
    SetWriter writer;
    Arena *arena = report->arena;
    Lines inputs = {.arena = arena};
    lines_put(&inputs, spec->input.file);
    const char *document = arena_format(arena, "%s/report.json", spec->tables);
    if (!set_writer_open(document, &inputs, &writer, err)) return false;
    bool ok = true;
    for (int i = 0; i < report->count && ok; i++) {
        const Table *table = report->table[i];
        if (!table->missing)
            ok = add_csv(&writer, arena_format(arena, "%s.csv", table->kind->key), table, *arena);
    }
    for (int i = 0; i < charts->count && ok; i++)
        ok = add_csv(&writer, chart_file(charts->chart[i], i, arena), charts->chart[i]->table,
                     *arena);
    ok = ok && set_writer_add_manifest(&writer, answer, 17);
    return set_writer_close(&writer, ok);
}

/* Contrast in the light needs both: what the panel shines and what it reflects. */
static bool can_be_lit(const PlotData *s, const ReportSpec *spec, Error *err) {
    const char *part = s->emits ? "reflection" : "emission";
    if (!spec->ambient.count || (s->emits && s->reflects)) return true;
    return error_at(err, ERROR_INPUT, s->file, "",
                    "has no %s data, which is required for --ambient; fit a set with a '%s' entry",
                    part, part);
}

bool panel_report_write(const ReportSpec *spec, Arena *arena, json_t **answer, Error *err) {
    PlotData *data = plot_data_new(&spec->input, arena, err);
    if (!data) return false;
    bool ok = can_be_lit(data, spec, err);
    if (ok) {
        const Report *report = panel_tables(data, &spec->ambient, arena);
        const PlotCharts charts =
            spec->page || spec->tables ? plot_charts(data, PLOT_ALL) : (PlotCharts){0};
        json_t *document = facts_json(data);
        json_object_set_new(document, "tables", tables_json(report));
        ok = (!spec->tables || write_csv(report, &charts, document, spec, err)) &&
             (!spec->page || write_page(data, &charts, report, spec, err));
        if (ok) *answer = document;
        else json_decref(document);
    }
    plot_data_free(data);
    return ok;
}
