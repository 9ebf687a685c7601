/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/report_table.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "page/page.h"
#include "panel/set/set_writer.h"
#include "text/json_text.h"

#define NOTHING "–"

/* ---- making ------------------------------------------------------------------------------ */

ReportTable *report_add(Report *report, const char *key, const char *title, const char *note) {
    ReportTable *table = &report->table[report->count++];
    *table = (ReportTable){.key = key, .title = title, .note = note};
    table->row =
        arena_alloc(report->arena, sizeof *table->row, _Alignof(ReportCell), REPORT_ROWS_MAX);
    return table;
}

void report_column(ReportTable *table, const char *key, const char *title) {
    table->column[table->column_count++] = (ReportColumn){key, title};
}

void report_missing(Report *report, const char *key, const char *title, const char *why) {
    report->table[report->count++] =
        (ReportTable){.key = key, .title = title, .note = "", .missing = why};
}

void report_row(Report *report, ReportTable *table) {
    (void)report;
    table->row_count++;
    table->filled = 0;
}

static void add_cell(ReportTable *table, ReportCell cell) {
    table->row[table->row_count - 1][table->filled++] = cell;
}

void report_text(ReportTable *table, const char *text) {
    add_cell(table, (ReportCell){text, false});
}

void report_fixed(Report *report, ReportTable *table, double value, int decimals) {
    if (!isfinite(value)) {
        report_text(table, NOTHING);
        return;
    }
    if (fabs(value) < 0.5 * pow(10, -decimals)) value = 0; /* no "-0.00" */
    add_cell(table, (ReportCell){arena_format(report->arena, "%.*f", decimals, value), true});
}

void report_figure(Report *report, ReportTable *table, double value) {
    double size = fabs(value);
    if (size > 0 && size < 1e-4 && isfinite(value)) {
        add_cell(table, (ReportCell){arena_format(report->arena, "%.3e", value), true});
        return;
    }
    int digits = size > 0 ? (int)floor(log10(size) + 1e-12) : 0;
    report_fixed(report, table, value, digits > 3 ? 0 : 3 - digits);
}

void report_beyond(Report *report, ReportTable *table, double last_deg) {
    report_text(table, arena_format(report->arena, "> %.4g", last_deg));
}

/* ---- on the page ------------------------------------------------------------------------- */

static bool is_number_column(const ReportTable *table, int c) {
    bool is_number = false;
    for (int r = 0; r < table->row_count; r++) is_number |= table->row[r][c].is_number;
    return is_number;
}

void report_set_columns(json_t *to, const char *kind, json_t *columns, json_t *rows) {
    page_set(to, "kind", kind);
    json_object_set_new(to, "columns", columns);
    json_object_set_new(to, "rows", rows);
}

void report_add_cell(json_t *cells, const char *text, bool is_number) {
    json_t *cell = page_add(cells);
    page_set(cell, "text", text);
    page_set_flag(cell, "n", is_number);
}

json_t *report_add_row(json_t *rows, bool is_total) {
    json_t *row = page_add(rows), *cells = json_array();
    page_set_flag(row, "is_total", is_total);
    json_object_set_new(row, "cells", cells);
    return cells;
}

void report_add_column(json_t *columns, const char *title, bool is_number) {
    json_t *column = page_add(columns);
    page_set(column, "title", title);
    page_set_flag(column, "n", is_number);
}

static json_t *table_values(const ReportTable *table) {
    json_t *to = json_object(), *columns = json_array(), *rows = json_array();
    page_set(to, "title", table->title);
    page_set(to, "missing", table->missing);
    page_set(to, "note", table->note);
    for (int c = 0; c < table->column_count; c++)
        report_add_column(columns, table->column[c].title, is_number_column(table, c));
    for (int r = 0; r < table->row_count; r++) {
        json_t *cells = report_add_row(rows, false);
        for (int c = 0; c < table->column_count; c++)
            report_add_cell(cells, table->row[r][c].text, is_number_column(table, c));
    }
    report_set_columns(to, table->key, columns, rows);
    return to;
}

json_t *report_values(const Report *report) {
    json_t *list = json_array();
    for (int i = 0; i < report->count; i++)
        json_array_append_new(list, table_values(&report->table[i]));
    return list;
}

/* ---- JSON and CSV ------------------------------------------------------------------------ */

static json_t *cell_json(const ReportCell *cell) {
    double number;
    bool is_number = cell->is_number && number_read(cell->text, &number);
    return is_number ? json_real(number) : json_text(cell->text);
}

json_t *report_json(const Report *report) {
    json_t *tables = json_array();
    for (int i = 0; i < report->count; i++) {
        const ReportTable *table = &report->table[i];
        json_t *rows = json_array();
        for (int r = 0; r < table->row_count; r++) {
            json_t *row = json_object();
            for (int c = 0; c < table->column_count; c++)
                json_object_set_new(row, table->column[c].key, cell_json(&table->row[r][c]));
            json_array_append_new(rows, row);
        }
        json_array_append_new(tables,
                              json_pack("{s:s, s:s, s:o, s:o, s:o}", "name", table->key, "title",
                                        table->title, "note", json_text(table->note), "missing",
                                        json_text_or_null(table->missing), "rows", rows));
    }
    return tables;
}

static Text table_csv(const ReportTable *table, Arena *arena) {
    Text csv = {.arena = arena};
    for (int c = 0; c < table->column_count; c++)
        text_format(&csv, "%s%s", c ? "," : "", table->column[c].key);
    text_add(&csv, "\n");
    for (int r = 0; r < table->row_count; r++) {
        for (int c = 0; c < table->column_count; c++) {
            if (c) text_add(&csv, ",");
            text_add_cell(&csv, table->row[r][c].text);
        }
        text_add(&csv, "\n");
    }
    return csv;
}

bool report_write_csv(const Report *report, const json_t *answer, const char *folder,
                      const char *input, Error *err) {
    SetWriter writer;
    Arena arena = *report->arena;
    Lines inputs = {.arena = &arena};
    lines_put(&inputs, input);
    const char *document = arena_format(&arena, "%s/report.json", folder);
    if (!set_writer_open(document, &inputs, &writer, err)) return false;
    bool ok = true;
    for (int i = 0; i < report->count && ok; i++) {
        const ReportTable *table = &report->table[i];
        if (table->missing) continue;
        Text csv = table_csv(table, &arena);
        ok = set_writer_add(&writer, arena_format(&arena, "%s.csv", table->key), &csv);
    }
    ok = ok && set_writer_add_manifest(&writer, answer, 17);
    return set_writer_close(&writer, ok);
}
