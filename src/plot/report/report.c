/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/report.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/units.h"
#include "page/page.h"
#include "panel/query/panel_info.h"
#include "plot/draw/ticks.h"
#include "plot/panel/grey_inversion.h"
#include "panel/set/set_writer.h"
#include "plot/report/file_report.h"
#include "plot/report/panel_tables.h"
#include "plot/report/report_figures.h"
#include "spectrum/gamut.h"
#include "text/json_text.h"

/* ---- what was measured, by whom, when ---------------------------------------------------- */

static const char *const STATED[] = {
    "panel",  "instrument",       "date",   "operator", "conditions",
    "source", "source_hash_xxh3", "verdict"};

static const char *stated(const PlotData *s, int i) {
    const char *text = json_string_value(json_object_get(s->source.report, STATED[i]));
    return text && *text ? arena_printable(s->arena, text) : NULL;
}

/* Degrees without the rounding of a cosine in the file. */
static json_t *degrees_json(bool is_there, double radians) {
    return is_there ? json_real(round(degrees_from_radians(radians) * 1e4) / 1e4) : json_null();
}

static json_t *facts_json(const PlotData *s) {
    json_t *out = json_object();
    for (int i = 0; i < COUNT_OF(STATED); i++)
        json_object_set_new(out, STATED[i], json_text_or_null(stated(s, i)));
    json_object_set_new(out, "file", json_text(s->source.file));
    json_object_set_new(out, "emission_to_theta_deg", degrees_json(s->emits, s->cone));
    json_object_set_new(out, "reflection_to_incidence_deg",
                        degrees_json(s->reflects, s->last_incidence));
    return out;
}

/* ---- the values looked at first --------------------------------------------------------- */

static void set_number(json_t *to, const char *name, double value) {
    json_object_set_new(to, name, json_figure(value));
}

static void set_white(json_t *to, const PlotData *s) {
    PanelColour colour = plot_data_normal(s, PATTERN_WHITE);
    ColourTemperature white = colour_temperature(colour.uv);
    set_number(to, "white_u", colour.uv[0]);
    set_number(to, "white_v", colour.uv[1]);
    set_number(to, "white_k", white.is_defined ? white.kelvin : (double)NAN);
    set_number(to, "white_duv", white.duv);
}

static void set_inversion(json_t *to, const PlotData *s) {
    GreyLevels levels = grey_levels(s);
    GreyInversion most = {0};
    if (levels.count) most = grey_inversion_most(s, &levels);
    page_set_flag(to, "no_inversion", levels.count && !(most.share > 0));
    if (!(most.share > 0)) return;
    json_object_set_new(to, "inversion",
                        json_pack("{s:f, s:f, s:f, s:f, s:f}", "percent", 100 * most.share,
                                  "theta_deg", degrees_from_radians(most.theta), "phi_deg",
                                  degrees_from_radians(most.phi), "low", most.low, "high",
                                  most.high));
}

static void set_emission(json_t *to, const PlotData *s) {
    double white = (double)s->normal[PATTERN_WHITE][1];
    double black = (double)s->normal[PATTERN_BLACK][1];
    set_number(to, "cone_deg", degrees_from_radians(s->cone));
    set_number(to, "white_cd_m2", white);
    set_number(to, "black_cd_m2", black);
    set_number(to, "contrast", panel_figure_contrast(s->source.panel, 0, 0));
    page_set_flag(to, "has_black", s->has_black);
    page_set_flag(to, "has_rim", s->cone < PI / 2 - 1e-3);
    set_white(to, s);
    set_inversion(to, s);
}

static void set_reflection(json_t *to, const PlotData *s) {
    set_number(to, "incidence_deg", degrees_from_radians(s->last_incidence));
    set_number(to, "leaving_deg", degrees_from_radians(s->brdf_cone));
    set_number(to, "albedo_percent",
               100 * panel_figure_diffuse(s->source.panel, radians_from_degrees(8)));
    page_set_flag(to, "has_hulls", panel_info_has_hulls(s->source.panel));
}

/* ---- the page ---------------------------------------------------------------------------- */

static const char *figure_words(double value, Arena *arena) {
    char number[32];
    return arena_format(arena, "%s", figure_text(value, number));
}

/* Takes the facts. */
static bool write_page(json_t *to, const PanelChartList *charts, const Report *report,
                       const PlotOptions *options, const char *path, Error *err) {
    const PlotData *s = charts->data;
    static const PageFormat FORMATS[] = {{"figure", figure_words}, {NULL, NULL}};
    Arena *arena = s->arena;
    page_set_flag(to, "is_dark", options->is_dark);
    page_set(to, "name", s->name);
    page_set(to, "file_name", s->file_name);
    json_object_set(to, "note", json_object_get(s->source.report, "note"));
    page_set_flag(to, "emits", s->emits);
    page_set_flag(to, "reflects", s->reflects);
    set_number(to, "mirror_percent",
               s->has_mirror ? 100 * panel_figure_mirror(s->source.panel, 0, 0) : NAN);
    if (s->emits) set_emission(to, s);
    if (s->reflects) set_reflection(to, s);
    json_t *tables = json_array();
    for (int i = 0; i < report->count; i++)
        json_array_append_new(tables, table_page(report->table[i]));
    json_object_set_new(to, "tables", tables);
    report_of_file(to, s->source.report, arena);
    if (page_set_head(to, s->name, "panel report", err) &&
        report_figures(to, charts, options->is_dark, arena, err))
        return page_write_values("panel.html", to, FORMATS, path, err);
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

/* "chart_07_local_gamma.csv" */
static const char *chart_file(const PanelChart *chart, int index, Arena *arena) {
    char *name = arena_format(arena, "chart_%02d_%s.csv", index + 1, chart->title);
    for (char *c = name; c[4]; c++)
        *c = isalnum((unsigned char)*c) ? (char)tolower((unsigned char)*c) : '_';
    return name;
}

static bool add_csv(SetWriter *writer, const char *name, const Table *table) {
    Text csv = {.arena = table->arena};
    table_add_csv(table, &csv);
    return set_writer_add(writer, name, &csv);
}

static bool add_chart_csv(SetWriter *writer, const char *name, const PanelChart *chart,
                          Arena scratch) {
    return add_csv(writer, name, report_chart_table(chart, &scratch));
}

/* KEY.csv of every table that is there, the values of every chart, and report.json with `answer`,
 * into a folder: all or none. input: a file that none of them may replace. */
static bool write_csv(const Report *report, const PanelChartList *charts, const json_t *answer,
                      const char *folder, const char *input, Error *err) {
    SetWriter writer;
    Arena *arena = report->arena;
    Lines inputs = {.arena = arena};
    lines_put(&inputs, input);
    const char *document = arena_format(arena, "%s/report.json", folder);
    if (!set_writer_open(document, &inputs, &writer, err)) return false;
    bool ok = true;
    for (int i = 0; i < report->count && ok; i++) {
        const Table *table = report->table[i];
        if (!table->missing)
            ok = add_csv(&writer, arena_format(arena, "%s.csv", table->kind->key), table);
    }
    for (int i = 0; i < charts->count && ok; i++)
        if (report_has_chart(&charts->chart[i]))
            ok = add_chart_csv(&writer, chart_file(&charts->chart[i], i, arena), &charts->chart[i],
                               *arena);
    ok = ok && set_writer_add_manifest(&writer, answer, 17);
    return set_writer_close(&writer, ok);
}

bool panel_report_write(const PlotInput *input, const PlotOptions *options,
                        const ReportOutput *output, Arena *arena, json_t **answer, Error *err) {
    json_t *source = NULL;
    PlotOptions all = *options;
    all.kind = PLOT_ALL;
    all.wants_reflectance = true;
    PlotData *data = plot_query(input, &all, arena, &source, err);
    if (!data) return false;
    const Report *report = panel_tables(data, arena);
    const PanelChartList *charts = plot_charts(data, PLOT_ALL, arena);
    json_t *document = facts_json(data);
    json_object_set_new(document, "tables", tables_json(report));
    bool ok =
        (!output->tables ||
         write_csv(report, charts, document, output->tables, input->file, err)) &&
        (!output->page || write_page(facts_json(data), charts, report, options, output->page, err));
    if (ok) *answer = document;
    else json_decref(document);
    json_decref(source);
    return ok;
}
