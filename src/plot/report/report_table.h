/* SPDX-License-Identifier: Apache-2.0 */
/* report_table.h -- the tables of a panel's report: one text a cell, which is the same on the
 * page, in CSV and in JSON, where a number is a number.
 *
 * Memory   the arena's. Threads: one at a time. Fails: report_write_csv with what cannot be
 *          written.
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>

#include "base/error.h"
#include "text/text.h"

#define REPORT_COLUMNS_MAX 16
#define REPORT_ROWS_MAX 256
#define REPORT_TABLES_MAX 24

typedef struct ReportColumn {
    const char *key;   /* in CSV and JSON, with its unit */
    const char *title; /* on the page, with its unit */
} ReportColumn;

typedef struct ReportCell {
    const char *text;
    bool is_number;
} ReportCell;

typedef struct ReportTable {
    const char *key, *title;
    const char *note;    /* how the figures are defined */
    const char *missing; /* why there is none; NULL: there is one */
    int column_count, row_count;
    ReportColumn column[REPORT_COLUMNS_MAX];
    ReportCell (*row)[REPORT_COLUMNS_MAX];
    int filled; /* cells of the last row */
} ReportTable;

typedef struct Report {
    Arena *arena;
    int count;
    ReportTable table[REPORT_TABLES_MAX];
} Report;

/* Another table; columns: a list of so many. */
ReportTable *report_add(Report *report, const char *key, const char *title, const char *note);
void report_column(ReportTable *table, const char *key, const char *title);

/* A table that is not there, and why. */
void report_missing(Report *report, const char *key, const char *title, const char *why);

/* Rows are filled from the left. A figure has four digits; what is not finite is "–". */
void report_row(Report *report, ReportTable *table);
void report_text(ReportTable *table, const char *text);
void report_fixed(Report *report, ReportTable *table, double value, int decimals);
void report_figure(Report *report, ReportTable *table, double value);

/* "> 60": not within what was measured, up to so many degrees. */
void report_beyond(Report *report, ReportTable *table, double last_deg);

/* What the template panel_table.html shows; of all tables of the report, and made by hand. */
json_t *report_values(const Report *report);
void report_add_column(json_t *columns, const char *title, bool is_number);
json_t *report_add_row(json_t *rows, bool is_total); /* its cells, borrowed */
void report_add_cell(json_t *cells, const char *text, bool is_number);
void report_set_columns(json_t *to, const char *kind, json_t *columns, json_t *rows);

json_t *report_json(const Report *report);

/* KEY.csv of every table that is there, and report.json with `answer`, into a folder: all or
 * none. input: a file that none of them may replace. */
bool report_write_csv(const Report *report, const json_t *answer, const char *folder,
                      const char *input, Error *err);
