/* SPDX-License-Identifier: Apache-2.0 */
#include "table/table.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "print/utf8.h"
#include "text/interval_text.h"
#include "text/json_text.h"

#define NOTHING "–"
#define LIST_MOST 12 /* names of a list that people read */
#define BAR 40       /* characters of the greatest */

/* ---- made by hand ------------------------------------------------------------------------ */

Table *table_new(const TableKind *kind, Arena *arena) {
    assert(kind->column_count <= TABLE_COLUMNS);
    Table *table = ARENA_NEW(arena, Table, 1);
    *table = (Table){.arena = arena, .kind = kind, .total_row = -1};
    return table;
}

void table_row(Table *table) {
    int columns = table->kind->column_count;
    if (table->row_count == table->row_capacity) {
        int capacity = table->row_capacity ? 2 * table->row_capacity : 8;
        table->cells = ARENA_GROW(table->arena, Cell, table->cells, table->row_count * columns,
                                  capacity * columns);
        table->row_capacity = capacity;
    }
    memset(table->cells + table->row_count * columns, 0, sizeof(Cell) * (size_t)columns);
    table->row_count++;
    table->filled = 0;
}

static Cell *cell_at(const Table *table, int column) {
    assert(column < table->kind->column_count);
    return &table->cells[(table->row_count - 1) * table->kind->column_count + column];
}

static Cell number_cell(double value) {
    return (Cell){.kind = CELL_NUMBER, .value = value, .low = NAN, .high = NAN};
}

void table_number(Table *table, double value) {
    *cell_at(table, table->filled++) = number_cell(value);
}

void table_text(Table *table, const char *text) {
    *cell_at(table, table->filled++) = (Cell){.kind = CELL_TEXT, .text = text};
}

/* ---- of a document ----------------------------------------------------------------------- */

/* "display.gamma.2": a member's member, an item; null where what should have it is null. Of "a|b"
 * the first that is there. */
static const json_t *value_at(const json_t *document, const char *path) {
    const json_t *value = document;
    for (;; path++) {
        size_t length = strcspn(path, ".|");
        uint64_t item = 0;
        value = json_is_array(value) && number_read_count(path, &item)
                    ? json_array_get(value, (size_t)item)
                    : json_object_getn(value, path, length);
        path += length;
        if (value && *path == '.' && !json_is_null(value)) continue;
        path += strcspn(path, "|");
        if (value || !*path) return value;
        value = document;
    }
}

static Cell cell_of(const json_t *value) {
    if (!value) return (Cell){.kind = CELL_ABSENT};
    if (json_is_string(value)) return (Cell){.kind = CELL_TEXT, .text = json_string_value(value)};
    if (json_is_boolean(value)) return (Cell){.kind = CELL_FLAG, .value = json_is_true(value)};
    if (json_is_array(value) || json_is_object(value))
        return (Cell){.kind = CELL_DOCUMENT, .document = value};
    Cell cell = number_cell(json_is_null(value) ? NAN : json_number_value(value));
    if (json_is_integer(value)) cell.kind = CELL_COUNT;
    return cell;
}

static Cell cell_in(const json_t *object, const Column *column) {
    Cell cell = cell_of(value_at(object, column->key));
    const json_t *ends = column->interval ? value_at(object, column->interval) : NULL;
    if (json_array_size(ends) != 2 || cell.kind == CELL_ABSENT) return cell;
    const json_t *high = json_array_get(ends, 1);
    cell.kind = CELL_NUMBER;
    cell.low = json_number_value(json_array_get(ends, 0));
    cell.high = json_is_number(high) ? json_number_value(high) : INFINITY;
    if (isinf(cell.high) && json_is_number(json_array_get(ends, 0)) && isnan(cell.value))
        cell.value = INFINITY;
    return cell;
}

void table_add_object(Table *table, const json_t *object) {
    table_row(table);
    for (int c = 0; c < table->kind->column_count; c++)
        *cell_at(table, c) = cell_in(object, &table->kind->columns[c]);
}

static Table *table_of_list(const TableKind *kind, const json_t *list, Arena *arena) {
    const json_t *object;
    size_t i;
    Table *table = table_new(kind, arena);
    json_array_foreach(list, i, object) table_add_object(table, object);
    return table;
}

static Table *table_of_lists(const TableKind *kind, const json_t *document, Arena *arena) {
    Table *table = table_new(kind, arena);
    size_t count = json_array_size(value_at(document, kind->columns[0].key));
    for (size_t i = 0; i < count; i++) {
        table_row(table);
        for (int c = 0; c < kind->column_count; c++)
            *cell_at(table, c) =
                cell_of(json_array_get(value_at(document, kind->columns[c].key), i));
    }
    return table;
}

static bool has_rows(const Column *column) {
    return column->of || column->lists;
}

/* The name with blanks for underscores. */
static const char *readable(const char *name, Arena *arena) {
    char *copy = arena_string(arena, name, strlen(name));
    for (char *c = copy; *c; c++)
        if (*c == '_') *c = ' ';
    return copy;
}

Table *table_of_objects(const Column *known, int known_count, const json_t *list, Arena *arena) {
    json_t *first = json_array_get(list, 0), *value;
    const char *key;
    if (!json_is_object(first)) return NULL;
    Column *columns = ARENA_NEW(arena, Column, json_object_size(first));
    TableKind *kind = ARENA_NEW(arena, TableKind, 1);
    *kind = (TableKind){.columns = columns};
    for (int k = 0; k < known_count; k++)
        if (json_object_get(first, known[k].key)) columns[kind->column_count++] = known[k];
    int known_here = kind->column_count;
    json_object_foreach(first, key, value) {
        bool is_known = false;
        for (int c = 0; c < known_here; c++) is_known |= !strcmp(columns[c].key, key);
        if (!is_known && kind->column_count < TABLE_COLUMNS)
            columns[kind->column_count++] = (Column){.key = key, .words = readable(key, arena)};
    }
    return table_of_list(kind, list, arena);
}

/* ---- a cell for people ------------------------------------------------------------------- */

static const char *fixed_text(double value, int decimals, Arena *arena) {
    if (fabs(value) < 0.5 * pow(10, -decimals)) value = 0; /* no "-0.00" */
    return arena_format(arena, "%.*f", decimals, value);
}

/* Never "1e+05"; below 1e-4 with an exponent. digits 0: no more than it takes. */
static const char *digits_text(double value, int digits, Arena *arena) {
    double size = fabs(value);
    if (!digits && size < 1e6) return arena_format(arena, "%.6g", value);
    if (!digits) digits = 7;
    if (size > 0 && size < 1e-4) return arena_format(arena, "%.*e", digits - 1, value);
    int place = size > 0 ? (int)floor(log10(size) + 1e-12) : 0;
    return fixed_text(value, place > digits - 1 ? 0 : digits - 1 - place, arena);
}

static const char *number_text(const Cell *cell, const Column *column, Arena *arena) {
    double times = column->times > 0 ? column->times : 1, value = cell->value * times;
    if (isnan(value)) return column->none;
    if (!isnan(cell->low))
        return interval_text(value, cell->low * times, cell->high * times, arena);
    if (isinf(value)) return value > 0 ? "infinite" : "-infinite";
    return column->is_fixed ? fixed_text(value, column->places, arena)
                            : digits_text(value, column->places, arena);
}

static const char *cell_text(const Cell *cell, const Column *column, Arena *arena);

/* "right 60.1, up 55.2": items under their names. */
static void add_list(Text *text, const json_t *list, const Column *column, const char *between) {
    const char *part = column->parts;
    const json_t *item;
    size_t i;
    json_array_foreach(list, i, item) {
        if (i == LIST_MOST && json_is_string(item)) {
            text_format(text, " and %d more", (int)(json_array_size(list) - i));
            return;
        }
        const Column own = {.is_fixed = column->is_fixed, .places = column->places};
        const Cell cell = cell_of(item);
        size_t length = part ? strcspn(part, "|") : 0;
        if (i) text_add(text, between);
        if (length) text_format(text, "%.*s ", (int)length, part);
        if (json_is_array(item)) add_list(text, item, &own, " ");
        else {
            const char *words = cell_text(&cell, column, text->arena);
            text_add(text, words ? words : NOTHING);
        }
        if (part) part += length + (part[length] == '|');
    }
}

/* "level 7; tolerance 0.0025": members that are no objects. */
static void add_members(Text *text, const json_t *object, const Column *column) {
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value) {
        const Cell cell = cell_of(value);
        if (json_is_object(value) || json_is_object(json_array_get(value, 0))) continue;
        const char *words = cell_text(&cell, column, text->arena);
        if (!words) continue;
        text_format(text, "%s%s %s", text->size ? "; " : "", readable(key, text->arena), words);
    }
}

static bool is_all_null(const json_t *list) {
    const json_t *item;
    size_t i;
    json_array_foreach(list, i, item) if (!json_is_null(item)) return false;
    return true;
}

static const char *cell_text(const Cell *cell, const Column *column, Arena *arena) {
    Text text = {.arena = arena};
    switch (cell->kind) {
    case CELL_ABSENT: return NULL;
    case CELL_NUMBER: return number_text(cell, column, arena);
    case CELL_COUNT:
        return column->times > 0 ? number_text(cell, column, arena)
                                 : arena_format(arena, "%.0f", cell->value);
    case CELL_FLAG: return cell->value > 0 ? "yes" : "no";
    case CELL_TEXT: return cell->text && *cell->text ? cell->text : column->none;
    case CELL_DOCUMENT: break;
    }
    if (has_rows(column)) return NULL;
    if (json_is_object(cell->document)) add_members(&text, cell->document, column);
    else if (is_all_null(cell->document)) return column->none;
    else add_list(&text, cell->document, column, ", ");
    return text.data;
}

static const Cell *cell_of_row(const Table *table, int row, int column) {
    return &table->cells[row * table->kind->column_count + column];
}

static const char *bar(const Table *table, int row, int column, Arena *arena) {
    double most = 0, value = cell_of_row(table, row, column)->value;
    for (int r = 0; r < table->row_count; r++)
        most = fmax(most, cell_of_row(table, r, column)->value);
    int length = most > 0 ? (int)(BAR * fmax(value, 0) / most + 0.5) : 0;
    return arena_format(arena, "%.*s", length, "########################################");
}

/* The views' own: what a text grows in may be a copy of the table's arena. */
static const char *words_of(const Table *table, int row, int column, Arena *arena) {
    const Column *of = &table->kind->columns[column];
    const Cell *cell = cell_of_row(table, row, column);
    if (of->is_bar) return bar(table, row, column, arena);
    const char *words = cell_text(cell, of, arena);
    return words || cell->kind == CELL_ABSENT ? words : NOTHING;
}

const char *table_cell_text(const Table *table, int row, int column) {
    return words_of(table, row, column, table->arena);
}

/* Absent, or null in a column that shows nothing then. */
static bool is_blank(const Cell *cell, const char *none) {
    bool is_null = cell->kind == CELL_TEXT ? !cell->text || !*cell->text
                                           : cell->kind == CELL_NUMBER && isnan(cell->value);
    return cell->kind == CELL_ABSENT || (is_null && none && !*none);
}

static bool has_column(const Table *table, int column) {
    const Column *of = &table->kind->columns[column];
    for (int r = 0; r < table->row_count; r++) {
        const Cell *cell = cell_of_row(table, r, column);
        bool is_zero = cell->kind <= CELL_FLAG && !(fabs(cell->value) > 0);
        if (!is_blank(cell, of->none) && !(of->hides_zero && is_zero)) return true;
    }
    return table->row_count == 0;
}

static bool is_read(const Table *table, int column) {
    return table->kind->columns[column].words && has_column(table, column);
}

/* Stands to the right: figures are in it, or none of what would be some. */
static bool is_number_column(const Table *table, int column) {
    bool has_null = false, has_text = false;
    for (int r = 0; r < table->row_count && !table->kind->columns[column].is_bar; r++) {
        const Cell *cell = cell_of_row(table, r, column);
        bool is_null = cell->kind == CELL_NUMBER && isnan(cell->value);
        if (cell->kind == CELL_COUNT || (cell->kind == CELL_NUMBER && !is_null)) return true;
        has_null |= is_null;
        has_text |= cell->kind == CELL_TEXT;
    }
    return has_null && !has_text;
}

/* ---- text -------------------------------------------------------------------------------- */

static int characters(const char *text, int length) {
    int count = 0;
    for (int i = 0; i < length; i++) count += !utf8_continues(text[i]);
    return count;
}

/* Of lines. */
static int widest(const char *text) {
    int most = 0;
    while (*text) {
        int length = (int)strcspn(text, "\n"), own = characters(text, length);
        if (own > most) most = own;
        text += length + (text[length] == '\n');
    }
    return most;
}

static void add_blanks(Text *text, int count) {
    for (; count > 0; count--) text_add(text, " ");
}

static const char *heading(const Column *column, Arena *arena) {
    return column->unit ? arena_format(arena, "%s, %s", column->words, column->unit)
                        : column->words;
}

typedef struct RowLines {
    int count; /* columns */
    int width[TABLE_COLUMNS];
    bool is_right[TABLE_COLUMNS];
    const char *left[TABLE_COLUMNS]; /* of the row's cells, what is not written */
} RowLines;

static void add_rows(const Table *table, bool has_headings, Text *text);

/* What a cell shows, in row -1 its heading; of a list that has columns lines. "": nothing. */
static const char *cell_lines(const Table *table, int row, int column, bool has_unit,
                              Arena *arena) {
    const Column *of = &table->kind->columns[column];
    const json_t *list = of->of && row >= 0 ? cell_of_row(table, row, column)->document : NULL;
    const json_t *item;
    const char *words = row < 0 ? heading(of, arena)
                        : list  ? NULL
                                : words_of(table, row, column, arena);
    Text text = {.arena = arena};
    size_t i;
    if (json_is_object(json_array_get(list, 0)))
        add_rows(table_of_list(of->of, list, arena), false, &text);
    else json_array_foreach(list, i, item) {
            text_add_printable(&text, json_string_value(item), json_string_length(item));
            text_add(&text, "\n");
        }
    if (words) text_add_printable(&text, words, strlen(words));
    if (words && has_unit && of->unit && strcmp(words, NOTHING) != 0)
        text_format(&text, " %s", of->unit);
    return text.data ? text.data : "";
}

/* How many rows from this one on read the same. */
static int alike_from(const Table *table, int row, Arena *arena) {
    int next = row + 1;
    for (; next < table->row_count; next++)
        for (int c = 0; c < table->kind->column_count; c++)
            if (strcmp(cell_lines(table, row, c, false, arena),
                       cell_lines(table, next, c, false, arena)) != 0)
                return next - row;
    return next - row;
}

/* Writes the next line of each cell, without its end; false: it was the last. */
static bool add_line(RowLines *lines, Text *text) {
    int owed = 0; /* blanks, which no line ends with */
    bool is_there = false;
    for (int c = 0; c < lines->count; c++) {
        if (lines->width[c] < 0) continue; /* it is not read */
        int length = (int)strcspn(lines->left[c], "\n");
        int rest = lines->width[c] - characters(lines->left[c], length);
        if (length) {
            add_blanks(text, owed + (lines->is_right[c] ? rest : 0));
            text_format(text, "%.*s", length, lines->left[c]);
            owed = 2 + (lines->is_right[c] ? 0 : rest);
        } else owed += lines->width[c] + 2;
        lines->left[c] += length + (lines->left[c][length] == '\n');
        is_there |= lines->left[c][0] != '\0';
    }
    return is_there;
}

/* Without headings a figure has its unit behind it. */
static void add_rows(const Table *table, bool has_headings, Text *text) {
    const TableKind *kind = table->kind;
    RowLines lines = {.count = kind->column_count};
    for (int c = 0; c < kind->column_count; c++) {
        lines.is_right[c] = is_number_column(table, c);
        lines.width[c] = -1;
        if (!is_read(table, c)) continue;
        for (int r = has_headings ? -1 : 0; r < table->row_count; r++) {
            int own = widest(cell_lines(table, r, c, !has_headings, text->arena));
            if (own > lines.width[c]) lines.width[c] = own;
        }
    }
    for (int r = has_headings ? -1 : 0; r < table->row_count; r++) {
        for (int c = 0; c < kind->column_count; c++)
            lines.left[c] =
                is_read(table, c) ? cell_lines(table, r, c, !has_headings, text->arena) : "";
        bool has_more = add_line(&lines, text);
        int alike = r < 0 ? 1 : alike_from(table, r, text->arena);
        if (alike > 1) text_format(text, "  %d times", alike);
        text_add(text, "\n");
        r += alike - 1;
        while (has_more) {
            has_more = add_line(&lines, text);
            text_add(text, "\n");
        }
    }
}

void table_add_text(const Table *table, Text *text) {
    if (table->kind->words) text_format(text, "%s\n", table->kind->words);
    add_rows(table, true, text);
}

/* A list of sentences has a line each. */
static bool is_sentences(const Cell *cell, const Column *column) {
    return cell->kind == CELL_DOCUMENT && !has_rows(column) && !column->parts &&
           json_is_string(json_array_get(cell->document, 0));
}

static int add_lines(const Column *column, const Cell *cell, TableLine *line, Arena *arena) {
    const json_t *sentence;
    size_t i;
    if (is_sentences(cell, column)) {
        json_array_foreach(cell->document, i, sentence) line[i] =
            (TableLine){column->words, json_string_value(sentence)};
        return (int)json_array_size(cell->document);
    }
    const char *words = cell_text(cell, column, arena);
    bool is_zero =
        cell->kind == CELL_FLAG ? !(cell->value > 0) : words && !words[strspn(words, "-0., ")];
    if (!words || !*words || (is_zero && column->hides_zero)) return 0;
    bool has_unit = column->unit && words != column->none;
    *line = (TableLine){column->words,
                        has_unit ? arena_format(arena, "%s %s", words, column->unit) : words};
    return 1;
}

TableLine *table_lines(const TableKind *kind, const json_t *document, Arena *arena, int *count) {
    int most = 0;
    for (int c = 0; c < kind->column_count; c++)
        most += 1 + (int)json_array_size(value_at(document, kind->columns[c].key));
    TableLine *lines = ARENA_NEW(arena, TableLine, most);
    *count = 0;
    for (int c = 0; c < kind->column_count; c++) {
        const Cell cell = cell_in(document, &kind->columns[c]);
        const Column *column = &kind->columns[c];
        bool is_left_out = column->unless && value_at(document, column->unless);
        if (column->words && !has_rows(column) && !is_left_out)
            *count += add_lines(column, &cell, lines + *count, arena);
    }
    return lines;
}

/* A line for each column. */
static void add_record(const TableKind *kind, const json_t *document, Text *text) {
    int count, width = 0;
    const TableLine *lines = table_lines(kind, document, text->arena, &count);
    for (int i = 0; i < count; i++)
        if (widest(lines[i].words) > width) width = widest(lines[i].words);
    for (int i = 0; i < count; i++) {
        text_add(text, lines[i].words);
        add_blanks(text, width + 2 - widest(lines[i].words));
        text_add_printable(text, lines[i].value, strlen(lines[i].value));
        text_add(text, "\n");
    }
}

static void add_table(const Column *column, const json_t *document, Text *text) {
    const json_t *list = value_at(document, column->key);
    if (json_array_size(list))
        table_add_text(column->of ? table_of_list(column->of, list, text->arena)
                                  : table_of_lists(column->lists, document, text->arena),
                       text);
}

/* Lines of columns, and tables where the columns have them, with blank lines between. */
static void add_document(const TableKind *kind, const json_t *document, Text *text) {
    bool has_text = false;
    for (int c = 0, next; c < kind->column_count; c = next) {
        const Column *first = &kind->columns[c];
        Text part = {.arena = text->arena};
        for (next = c + 1; !has_rows(first) && next < kind->column_count; next++)
            if (has_rows(&kind->columns[next])) break;
        const TableKind lines = {.columns = first, .column_count = next - c};
        if (has_rows(first)) add_table(first, document, &part);
        else add_record(&lines, document, &part);
        if (part.size && has_text) text_add(text, "\n");
        if (part.size) text_add(text, part.data);
        has_text |= part.size > 0;
    }
}

void table_add_document(const TableKind *kind, const json_t *document, Text *text) {
    const json_t *one;
    size_t i;
    bool is_alone = false;
    for (int c = 0; c < kind->column_count; c++) is_alone |= has_rows(&kind->columns[c]);
    if (!json_is_array(document)) add_document(kind, document, text);
    else if (!is_alone) table_add_text(table_of_list(kind, document, text->arena), text);
    else json_array_foreach(document, i, one) {
            if (i) text_add(text, "\n");
            add_document(kind, one, text);
        }
}

/* ---- JSON, CSV, page --------------------------------------------------------------------- */

static void add_kind(json_t *list, const TableKind *kind, const char *before, Arena *arena) {
    for (int c = 0; c < kind->column_count; c++) {
        const Column *column = &kind->columns[c];
        const char *other = strchr(column->key, '|'); /* a list of texts in the place of rows */
        int length = (int)strcspn(column->key, "|");
        const char *key = arena_format(arena, "%s%.*s", before, length, column->key);
        const char *interval =
            column->interval ? arena_format(arena, "%s%s", before, column->interval) : NULL;
        const char *unit = column->times > 0 ? column->times == 100 ? "share" : NULL : column->unit;
        if (column->lists) add_kind(list, column->lists, before, arena);
        if (column->of) add_kind(list, column->of, arena_format(arena, "%s[].", key), arena);
        if (other) key = arena_format(arena, "%s%s", before, other + 1);
        if ((has_rows(column) && !other) || column->is_bar) continue;
        json_t *one = json_pack("{s:s, s:s*, s:s*, s:s*, s:s*, s:s*}", "key", key, "unit", unit,
                                "words", column->words, "none", column->none, "about",
                                column->about, "interval", interval);
        json_array_append_new(list, one);
    }
}

json_t *table_kind_json(const TableKind *kind) {
    Arena arena = arena_reserve((size_t)1 << 24);
    json_t *list = json_array();
    add_kind(list, kind, "", &arena);
    arena_release(&arena);
    return list;
}

json_t *table_json(const Table *table) {
    json_t *rows = json_array();
    for (int r = 0; r < table->row_count; r++) {
        json_t *object = json_object();
        for (int c = 0; c < table->kind->column_count; c++) {
            const char *words = table_cell_text(table, r, c);
            double number;
            bool is_number = table->cells[r * table->kind->column_count + c].kind == CELL_NUMBER &&
                             number_read(words, &number);
            if (words)
                json_object_set_new(object, table->kind->columns[c].key,
                                    is_number ? json_real(number) : json_text(words));
        }
        json_array_append_new(rows, object);
    }
    return rows;
}

void table_add_csv(const Table *table, Text *csv) {
    bool has[TABLE_COLUMNS];
    for (int c = 0; c < table->kind->column_count; c++) has[c] = has_column(table, c);
    for (int r = -1; r < table->row_count; r++) {
        bool is_first = true;
        for (int c = 0; c < table->kind->column_count; c++) {
            if (!has[c]) continue;
            const char *words =
                r < 0 ? table->kind->columns[c].key : words_of(table, r, c, csv->arena);
            if (!is_first) text_add(csv, ",");
            text_add_cell(csv, words ? words : "");
            is_first = false;
        }
        text_add(csv, "\n");
    }
}

json_t *table_page(const Table *table) {
    json_t *columns = json_array(), *rows = json_array();
    bool is_shown[TABLE_COLUMNS], is_right[TABLE_COLUMNS];
    for (int c = 0; c < table->kind->column_count; c++) {
        is_shown[c] = is_read(table, c);
        is_right[c] = is_number_column(table, c);
    }
    for (int r = -1; r < table->row_count; r++) {
        json_t *cells = r < 0 ? columns : json_array();
        for (int c = 0; c < table->kind->column_count; c++) {
            if (!is_shown[c]) continue;
            const char *words = r < 0 ? heading(&table->kind->columns[c], table->arena)
                                      : table_cell_text(table, r, c);
            json_array_append_new(cells,
                                  json_pack("{s:o, s:b}", r < 0 ? "title" : "text",
                                            json_text(words ? words : ""), "n", (int)is_right[c]));
        }
        if (r >= 0)
            json_array_append_new(rows, json_pack("{s:b, s:o}", "is_total",
                                                  (int)(r == table->total_row), "cells", cells));
    }
    return json_pack("{s:s?, s:o, s:o, s:s, s:o, s:o}", "title", table->kind->words, "missing",
                     json_text_or_null(table->missing), "note", json_text_or_null(table->note),
                     "kind", table->kind->key ? table->kind->key : "", "columns", columns, "rows",
                     rows);
}
