/* SPDX-License-Identifier: Apache-2.0 */
#include "text/csv_table.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/number.h"
#include "text/nearest_word.h"

#define FILE_BYTES_MAX ((size_t)4 << 30)

typedef struct Scan {
    const char *next, *end; /* of the text */
    int line;
    char separator; /* that of the header line */
    Arena *arena;
    Error *err;
} Scan;

static bool is_blank(char c) {
    return c == ' ' || c == '\r';
}

/* The first of these that the header line has: behind a semicolon or tab a comma is none. */
static char find_separator(const char *text, const char *stop) {
    for (const char *one = ";\t"; *one; one++)
        if (memchr(text, *one, (size_t)(stop - text))) return *one;
    return ',';
}

/* Is a comma between digits, without a point, the reason that a row does not fit? */
static const char *comma_hint(const char *text, const char *stop) {
    if (memchr(text, '.', (size_t)(stop - text))) return "";
    for (const char *at = text + 1; at + 1 < stop; at++)
        if (*at == ',' && isdigit((unsigned char)at[-1]) && isdigit((unsigned char)at[1]))
            return " — a decimal comma? Required are decimal points";
    return "";
}

static const char *place_of(const Scan *scan) {
    return arena_format(scan->arena, "line %d", scan->line);
}

/* Moves to the next line that holds something; false at the end. *stop is its end. */
static bool next_line(Scan *scan, const char **begin, const char **stop) {
    while (scan->next < scan->end) {
        const char *start = scan->next;
        const char *feed = memchr(start, '\n', (size_t)(scan->end - start));
        *stop = feed ? feed : scan->end;
        scan->next = feed ? feed + 1 : scan->end;
        scan->line++;
        while (start < *stop && is_blank(*start)) start++;
        if (start < *stop && *start != '#') {
            *begin = start;
            return true;
        }
    }
    return false;
}

static bool read_names(Scan *scan, CsvTable *table, Error *err) {
    const char *text, *stop;
    if (!next_line(scan, &text, &stop))
        return error_at(err, ERROR_INPUT, table->file, "",
                        "is empty, required: a header line and rows of numbers");
    scan->separator = find_separator(text, stop);
    table->name = ARENA_NEW(scan->arena, const char *, CSV_COLUMNS_MAX);
    while (table->columns < CSV_COLUMNS_MAX) {
        const char *cell = text;
        while (text < stop && *text != scan->separator) text++;
        const char *last = text;
        while (cell < last && is_blank(*cell)) cell++;
        while (last > cell && is_blank(last[-1])) last--;
        table->name[table->columns++] = arena_string(scan->arena, cell, (size_t)(last - cell));
        if (text == stop) return true;
        text++;
    }
    return error_at(err, ERROR_INPUT, table->file, place_of(scan), "has more than %d columns",
                    CSV_COLUMNS_MAX);
}

/* Refuses a repeated name: a search would find the first of two only. */
static bool check_names(const Scan *scan, const CsvTable *table, Error *err) {
    for (int c = 1; c < table->columns; c++)
        if (csv_table_column(table, table->name[c]) < c)
            return error_at(err, ERROR_INPUT, table->file, place_of(scan),
                            "has the column '%s' twice", table->name[c]);
    return true;
}

static bool bad_cell(const Scan *scan, const CsvTable *table, int column, const char *text,
                     const char *stop) {
    int length = 0;
    while (text + length < stop && text[length] != scan->separator && length < 40) length++;
    return error_at(scan->err, ERROR_INPUT, table->file, place_of(scan),
                    "column '%s' holds '%.*s', required: a finite "
                    "number%s",
                    table->name[column], length, text, comma_hint(text, text + length));
}

static bool read_row(Scan *scan, const CsvTable *table, const char *text, const char *stop,
                     float *cell) {
    const char *line = text;
    for (int c = 0; c < table->columns; c++) {
        while (text < stop && is_blank(*text)) text++;
        if (text >= stop || *text == scan->separator) return bad_cell(scan, table, c, text, stop);
        const char *after = number_read_float(text, &cell[c]);
        if (!after || after > stop) return bad_cell(scan, table, c, text, stop);
        const char *begin = text;
        text = after;
        while (text < stop && is_blank(*text)) text++;
        bool is_last = c == table->columns - 1;
        if (is_last && text < stop && *text != scan->separator)
            return bad_cell(scan, table, c, begin, stop);
        if (is_last ? text != stop : text == stop)
            return error_at(scan->err, ERROR_INPUT, table->file, place_of(scan),
                            "has %s cells than the header's %d columns%s",
                            is_last ? "more" : "fewer", table->columns,
                            is_last ? comma_hint(line, stop) : "");
        if (!is_last && *text != scan->separator) return bad_cell(scan, table, c, begin, stop);
        text++;
    }
    return true;
}

static int count_lines(const char *text, const char *end) {
    int count = 1;
    while ((text = memchr(text, '\n', (size_t)(end - text)))) {
        count++;
        text++;
    }
    return count;
}

bool csv_table_read(const char *file, Arena *arena, CsvTable *out, Error *err) {
    FileBytes bytes;
    if (!file_read(file, FILE_BYTES_MAX, arena, &bytes, err)) return false;
    FileBytes unmarked = file_unmarked(bytes);
    const char *text = (const char *)unmarked.data;
    Scan scan = {text, text + unmarked.size, 0, ',', arena, err};
    CsvTable table = {.file = file, .bytes = bytes.size};
    if (!read_names(&scan, &table, err) || !check_names(&scan, &table, err)) return false;
    int most = count_lines(scan.next, scan.end);
    float *cell = ARENA_NEW(arena, float, (size_t)most *(size_t)table.columns);
    int *line = ARENA_NEW(arena, int, most);
    const char *begin, *stop;
    while (next_line(&scan, &begin, &stop)) {
        float *row = cell + (size_t)table.rows * (size_t)table.columns;
        if (!read_row(&scan, &table, begin, stop, row)) return false;
        line[table.rows++] = scan.line;
    }
    if (!table.rows) return error_at(err, ERROR_INPUT, file, "", "has a header line but no rows");
    table.cell = cell;
    table.line = line;
    *out = table;
    return true;
}

int csv_table_column(const CsvTable *table, const char *name) {
    for (int c = 0; c < table->columns; c++)
        if (!strcmp(table->name[c], name)) return c;
    return -1;
}

bool csv_table_check_columns(const CsvTable *table, const char *const *known, int count,
                             Error *err) {
    for (int c = 0; c < table->columns; c++) {
        bool found = false;
        for (int i = 0; i < count && !found; i++) found = !strcmp(table->name[c], known[i]);
        if (!found)
            return error_at(err, ERROR_INPUT, table->file, "header line",
                            "column '%s' is unknown; the nearest known one is '%s'", table->name[c],
                            nearest_word(table->name[c], known, count));
    }
    return true;
}

const char *csv_table_place(const CsvTable *table, int row, Arena *arena) {
    return arena_format(arena, "line %d", table->line[row]);
}
