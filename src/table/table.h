/* SPDX-License-Identifier: Apache-2.0 */
/* table.h -- a result as rows: columns that say what a figure is, cells, and views of them.
 *
 * Cells are set one by one, or they are the members of a JSON document: then the console and
 * --json show the same cells. A record has one row, whose columns people read below each other.
 *
 * Units    the column's.
 * Memory   the arena's; texts and documents are borrowed.
 * Threads  one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>

#include "base/count.h"
#include "text/text.h"

#define TABLE_COLUMNS 128 /* at most; of a document with more the first */

typedef struct TableKind TableKind;

typedef struct Column {
    const char *key;   /* in JSON and CSV, with its unit; of a document a path, "display.gamma.2";
                           "a|b": the first that is there */
    const char *words; /* for people; NULL: not for them */
    const char *unit;  /* for people, behind the figure; NULL: none */
    bool is_fixed;     /* `places` are digits behind the point, else digits that count */
    int places;        /* 0 of the latter: 6, without zeros at the end */
    double times;      /* for people: so many times the cell's value (100: percent); 0: once */
    const char *interval;   /* path of [low, high], which then decides the digits; NULL: none */
    const char *parts;      /* of a list: what its items are, "right|up|left|down"; "": they stand
                                in one line, also sentences */
    const char *none;       /* for people, where it is null; NULL: a record leaves the line out, and
                               rows have a dash; "": both nothing, and a column of it is left out */
    const char *unless;     /* path: a record leaves the line out where it is there */
    bool hides_zero;        /* a record leaves the line out that would show 0, or no; rows the
                               column in which all do or have no figure */
    bool is_bar;            /* of rows: a bar, against the column's greatest */
    const TableKind *of;    /* of lists of objects: rows, a table in the column's place; of a row
                               lines in its cell, also of texts */
    const TableKind *lists; /* of a list: rows of it and of those that the kind's keys name, an item
                               of each a row */
    const char *about;      /* for who reads JSON: what words leave open; NULL: nothing */
} Column;

struct TableKind {
    const char *key;   /* of its file of CSV, and on a page its class */
    const char *words; /* heading; NULL: none */
    const Column *columns;
    int column_count;
};

#define TABLE_KIND(key_, words_, columns_) \
    {.key = key_, .words = words_, .columns = columns_, .column_count = COUNT_OF(columns_)}

/* Columns of texts; of so many digits behind the point; of so many that count; of shares, in
 * percent. */
#define COLUMN_TEXT(key_, words_) {.key = key_, .words = words_}
#define COLUMN_FIXED(key_, words_, unit_, places_) \
    {.key = key_, .words = words_, .unit = unit_, .is_fixed = true, .places = places_}
#define COLUMN_DIGITS(key_, words_, unit_, places_) \
    {.key = key_, .words = words_, .unit = unit_, .places = places_}
#define COLUMN_SHARE(key_, words_) \
    {.key = key_, .words = words_, .unit = "%", .places = 3, .times = 100}

/* For JSON alone. What is about an object or a list holds for all that is in it. */
#define COLUMN_KEY(key_, about_) {.key = key_, .about = about_}

/* With an interval, which decides the digits. */
#define COLUMN_MEASURED(key_, words_, unit_, interval_) \
    {.key = key_, .words = words_, .unit = unit_, .interval = interval_}

typedef enum CellKind {
    CELL_ABSENT,
    CELL_NUMBER, /* NaN: there is none */
    CELL_COUNT,
    CELL_FLAG,
    CELL_TEXT,
    CELL_DOCUMENT /* a list or an object */
} CellKind;

typedef struct Cell {
    CellKind kind;
    double value, low, high; /* NaN: no interval; infinite: no upper end */
    const char *text;        /* NULL: there is none */
    const json_t *document;
} Cell;

typedef struct Table {
    Arena *arena;
    const TableKind *kind;
    const char *note;    /* how the figures are defined; NULL: nothing */
    const char *missing; /* why there is none; NULL: there is one */
    int row_count, row_capacity, filled;
    Cell *cells;   /* [row_count][kind->column_count] */
    int total_row; /* that sums up the others; -1: none */
} Table;

/* ---- made by hand ------------------------------------------------------------------------ */

Table *table_new(const TableKind *kind, Arena *arena);

/* Another row, whose cells are filled from the left. */
void table_row(Table *table);
void table_number(Table *table, double value);
void table_text(Table *table, const char *text);

/* ---- of a document ----------------------------------------------------------------------- */

/* A row for each object of the list. Its columns are the members of the first one: the known of
 * them in their order, then the others under their own names. NULL: there is no object. */
Table *table_of_objects(const Column *known, int known_count, const json_t *list, Arena *arena);

void table_add_object(Table *table, const json_t *object);

/* ---- views ------------------------------------------------------------------------------- */

/* The cell as people read it, without its unit; NULL: nothing is shown. */
const char *table_cell_text(const Table *table, int row, int column);

/* Columns under their headings; rows that read alike stand once, "13 times". In all views of rows a
 * figure that there is not is a dash, and a column that no row has is left out. A list in a row has
 * a line each, of objects without headings but with units. */
void table_add_text(const Table *table, Text *text);

/* The document as people read it: for each column of the kind its words, and the figure with its
 * unit; a list of sentences has a line each. */
typedef struct TableLine {
    const char *words, *value;
} TableLine;

TableLine *table_lines(const TableKind *kind, const json_t *document, Arena *arena, int *count);

/* The same as text, with the tables of its lists; a list of documents as rows, or, where they have
 * tables, one below the other. */
void table_add_document(const TableKind *kind, const json_t *document, Text *text);

/* What a document of the kind has, for who reads it as JSON: of each column "key", of a list of
 * objects those of its rows as "lights[].name", and as far as they are there "unit", "words",
 * "interval", "none" and "about"; a share has the unit "share". */
json_t *table_kind_json(const TableKind *kind);

/* A list of objects; numbers are those that people read. */
json_t *table_json(const Table *table);

/* A line of keys, then one for each row, as people read them. */
void table_add_csv(const Table *table, Text *csv);

/* What the template panel_table.html shows, with title, note and missing. */
json_t *table_page(const Table *table);
