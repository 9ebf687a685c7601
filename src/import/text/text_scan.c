/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_scan.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "import/set/import.h"
#include "import/text/text_blocks.h"
#include "import/text/text_names.h"

/* ---- metadata --------------------------------------------------------------------------- */

/* The metadata in the lines around a file's numbers. */

#define KEY_LENGTH 48

typedef struct KeyValue {
    char key[KEY_LENGTH]; /* lower case; blanks and underscores left out */
    TextLine value;
} KeyValue;

/* "Sample;blue 127", "Unit: cd/m2", "level = 255". No separator: the key is empty. */
static KeyValue cut_key(TextLine line) {
    KeyValue pair = {.value = line};
    int i = 0, n = 0;
    while (i < line.length && !strchr(":;=,\t", line.text[i])) i++;
    if (i == line.length) return pair;
    for (int k = 0; k < i && n < KEY_LENGTH - 1; k++)
        if (!strchr(" _-[]\"", line.text[k]))
            pair.key[n++] = (char)tolower((unsigned char)line.text[k]);
    while (i < line.length && strchr(":;=,\t \"", line.text[i])) i++;
    pair.value = (TextLine){line.text + i, line.length - i};
    while (pair.value.length && strchr(";,\t \"", pair.value.text[pair.value.length - 1]))
        pair.value.length--;
    return pair;
}

static void read_azimuth(TextMetadata *metadata, TextLine line, int index) {
    bool about = line_has(line, "azim") || line_has(line, "phi") || line_has(line, "clockwise") ||
                 line_has(line, "orientation");
    if (!about) return;
    AzimuthWords words = azimuth_words(line);
    if (words.has_zero) {
        metadata->azimuth.has_zero = true;
        metadata->azimuth.zero_deg = words.zero_deg;
        metadata->zero_line = index;
    }
    if (words.has_sense) {
        metadata->azimuth.has_sense = true;
        metadata->azimuth.sense = words.sense;
        metadata->sense_line = index;
    }
    if (words.has_side) {
        metadata->azimuth.has_side = true;
        metadata->azimuth.is_behind = words.is_behind;
        metadata->side_line = index;
    }
}

static void read_metadata_units(TextMetadata *metadata, const KeyValue *pair, int index) {
    static const char *const unit_keys[] = {"unit", "units", "valueunit", "luminanceunit", NULL};
    static const char *const angle_keys[] = {"angleunit", "angleunits", "angles", "angle", NULL};
    if (import_word_find(unit_keys, pair->key) >= 0) {
        ValueUnit unit = value_unit((TextCell){pair->value.text, pair->value.length});
        if (unit != UNIT_AUTO) {
            metadata->unit = unit;
            metadata->unit_line = index;
        }
    }
    if (import_word_find(angle_keys, pair->key) >= 0) {
        AngleUnit unit = line_has(pair->value, "rad")   ? ANGLE_RADIANS
                         : line_has(pair->value, "deg") ? ANGLE_DEGREES
                                                        : ANGLE_AUTO;
        if (unit != ANGLE_AUTO) {
            metadata->angle = unit;
            metadata->angle_line = index;
        }
    }
}

static TextMetadata text_metadata(void) {
    return (TextMetadata){
        .zero_line = -1, .sense_line = -1, .side_line = -1, .unit_line = -1, .angle_line = -1};
}

/* Reads a line that is no row of numbers; its index is for messages. */
static void text_metadata_read_line(TextMetadata *metadata, TextLine line, int index) {
    KeyValue pair = cut_key(line);
    read_azimuth(metadata, line, index);
    read_metadata_units(metadata, &pair, index);
}

/* Where the reader is in the file. */
typedef enum State {
    STATE_BEFORE, /* no numbers yet, or between blocks */
    STATE_LIST,
    STATE_BLOCK,
    STATE_DONE /* behind the last row of a list */
} State;

typedef struct TextScan {
    const TextFile *text;
    const TextOptions *options;
    TextDialect dialect;
    Arena *arena;
    Error *err;
    TextMetadata *metadata;
    NamedRows *table;
    TextBlocks blocks;
    State state;
    int at;         /* index of the current line */
    TextCell *cell; /* of the current line */
    int count;
    bool has_header; /* the table's columns are known */
    int header_cells;
} TextScan;

/* An error at the current line. Always false. */
__attribute__((format(printf, 2, 3))) static bool bad_line(const TextScan *scan, const char *format,
                                                           ...) {
    va_list list;
    va_start(list, format);
    error_at_list(scan->err, ERROR_INPUT, scan->text->file, text_place(scan->at, scan->arena),
                  format, list);
    va_end(list);
    return false;
}

/* ---- cells ------------------------------------------------------------------------------- */

static bool is_users_mask(const TextScan *scan, TextCell cell, double value, bool is_number) {
    const TextList *mask = &scan->options->mask;
    for (int i = 0; i < mask->count; i++) {
        double marked;
        TextCell text = {mask->text[i], (int)strlen(mask->text[i])};
        if (text.length == cell.length && !memcmp(text.text, cell.text, (size_t)text.length))
            return true;
        if (is_number && text_number(text, '.', &marked) && marked == value) return true;
    }
    return false;
}

/* A number, or NAN for a mark of what was not measured. */
static bool read_cell(const TextScan *scan, TextCell cell, double *out) {
    double value = NAN;
    bool is_number = text_number(cell, scan->dialect.decimal, &value);
    if (!is_number && !text_is_masked(cell) && !is_users_mask(scan, cell, 0, false)) return false;
    *out = is_number && !is_users_mask(scan, cell, value, true) ? value : NAN;
    return true;
}

static bool bad_cell(const TextScan *scan, TextCell cell, const char *column) {
    return bad_line(scan,
                    "column '%s' holds '%.*s', required: a number or a mark of what was "
                    "not measured (---, NaN, or one given as --mask)",
                    column, cell.length < 40 ? cell.length : 40, cell.text);
}

static bool is_number(const TextScan *scan, TextCell cell) {
    double value;
    return text_number(cell, scan->dialect.decimal, &value);
}

/* Numbers and marks, at least one number. */
static bool is_row(const TextScan *scan, const TextCell *cell, int count) {
    int numbers = 0;
    double value;
    for (int i = 0; i < count; i++) {
        if (!read_cell(scan, cell[i], &value)) return false;
        numbers += !isnan(value);
    }
    return numbers > 0;
}

/* ---- rows of a list ---------------------------------------------------------------------- */

static bool add_list_row(TextScan *scan) {
    NamedRows *table = scan->table;
    int wanted = scan->header_cells;
    bool has_final = scan->count == wanted + 1 && !scan->cell[wanted].length;
    if (scan->count != wanted && !has_final)
        return bad_line(scan, "has %d cells, required: %d as the columns are", scan->count, wanted);
    if (table->rows.count >= IMPORT_ROWS_MAX)
        return bad_line(scan, "is one row too many, required: at most %d", IMPORT_ROWS_MAX);
    double *row = text_rows_add(&table->rows, scan->at, scan->arena);
    for (int c = 0; c < table->rows.width; c++) {
        TextCell cell = scan->cell[table->column[c].from];
        if (!read_cell(scan, cell, &row[c])) return bad_cell(scan, cell, table->column[c].text);
    }
    return true;
}

/* ---- headers ----------------------------------------------------------------------------- */

static bool add_column(TextScan *scan, ColumnName name, const char *text, int from) {
    NamedRows *table = scan->table;
    for (int c = 0; c < table->rows.width; c++)
        if (table->column[c].name.quantity == name.quantity &&
            table->column[c].name.wavelength_nm == name.wavelength_nm)
            return bad_line(scan,
                            "columns '%s' and '%s' name the same quantity — say which is "
                            "which with --columns (- skips one)",
                            table->column[c].text, text);
    if (table->rows.width == TEXT_COLUMNS_MAX)
        return bad_line(scan, "has more than %d columns", TEXT_COLUMNS_MAX);
    table->column[table->rows.width++] = (NamedColumn){name, text, from};
    return true;
}

static bool has_direction(const TextCell *cell, int count) {
    bool seen[QUANTITY_COUNT] = {false};
    for (int i = 0; i < count; i++) seen[column_name(cell[i]).quantity] = true;
    return (seen[QUANTITY_THETA] && seen[QUANTITY_PHI]) ||
           (seen[QUANTITY_HORIZONTAL] && seen[QUANTITY_VERTICAL]);
}

/* theta and something measured, but no azimuth: a section. */
static bool has_section(const TextCell *cell, int count) {
    bool has_theta = false, has_value = false;
    for (int i = 0; i < count; i++) {
        Quantity quantity = column_name(cell[i]).quantity;
        has_theta |= quantity == QUANTITY_THETA;
        has_value |= quantity >= QUANTITY_X;
    }
    return has_theta && has_value;
}

/* The cells of a header as columns; names that are not known are not used. */
static bool read_header(TextScan *scan, const TextCell *cell, int count, bool from_user) {
    scan->table->rows.width = 0;
    scan->header_cells = count;
    for (int i = 0; i < count; i++) {
        const char *text = arena_string(scan->arena, cell[i].text, (size_t)cell[i].length);
        ColumnName name = column_name(cell[i]);
        if (name.is_ambiguous)
            return bad_line(scan,
                            "column '%s' may be CIE 1960 or 1976 — name the columns with "
                            "--columns, u' and v' for 1976",
                            text);
        if (name.quantity == QUANTITY_NONE && from_user && strcmp(text, "-") != 0)
            return error_set(scan->err, ERROR_USAGE,
                             "--columns: '%s' is no name of a column, "
                             "required: theta, phi, X, Y, Z, L, x, y, u', v', a wavelength, "
                             "incidence, ... or -",
                             text);
        scan->metadata->unused_columns += name.quantity == QUANTITY_NONE;
        if (name.quantity != QUANTITY_NONE && !add_column(scan, name, text, i)) return false;
    }
    scan->has_header = true;
    return true;
}

static bool read_users_columns(TextScan *scan) {
    TextCell *cell = ARENA_NEW(scan->arena, TextCell, TEXT_CELLS_MAX);
    TextLine line = {scan->options->columns, (int)strlen(scan->options->columns)};
    int count = text_cells(line, ',', cell);
    if (count < 0) return error_set(scan->err, ERROR_USAGE, "--columns has too many names");
    if (!has_direction(cell, count) && !has_section(cell, count))
        return error_set(scan->err, ERROR_USAGE,
                         "--columns '%s' has no two angles, required: theta and phi, or "
                         "horizontal and vertical",
                         scan->options->columns);
    return read_header(scan, cell, count, true);
}

/* ---- lines ------------------------------------------------------------------------------- */

/* How many characters begin a comment; 0: it is none. */
static int comment_length(const TextScan *scan, TextLine line) {
    static const char *const known[] = {"#", "!", "%", "//"};
    const TextList *more = &scan->options->comment;
    for (int i = 0; i < 4 + more->count; i++) {
        const char *begin = i < 4 ? known[i] : more->text[i - 4];
        int length = (int)strlen(begin);
        if (line.length >= length && !memcmp(line.text, begin, (size_t)length)) return length;
    }
    return 0;
}

/* The next line that holds something is a row of as many numbers: what stands above may be a
 * matrix's head. */
static bool row_follows(const TextScan *scan, int count) {
    Arena scratch = *scan->arena;
    TextCell *cell = ARENA_NEW(&scratch, TextCell, TEXT_CELLS_MAX);
    int next = scan->at + 1;
    while (next < scan->text->count && !scan->text->line[next].length) next++;
    if (next == scan->text->count) return false;
    int found = text_cells(scan->text->line[next], scan->dialect.delimiter, cell);
    return found == count && is_number(scan, cell[0]) && is_row(scan, cell, found);
}

/* A corner, then rising or falling angles, then rows under them. */
static bool is_matrix_head(const TextScan *scan) {
    int count = scan->count - (scan->count > 2 && !scan->cell[scan->count - 1].length);
    double last = 0, value, step = 0;
    if (count < 2 || is_number(scan, scan->cell[0])) return false;
    for (int i = 1; i < count; i++) {
        if (!text_number(scan->cell[i], scan->dialect.decimal, &value)) return false;
        if (i == 2) step = value - last;
        if (i > 1 && !((value - last) * step > 0)) return false;
        last = value;
    }
    return row_follows(scan, scan->count);
}

static bool begin_block(TextScan *scan) {
    scan->state = STATE_BLOCK;
    return text_blocks_begin(&scan->blocks, scan->cell, scan->count, scan->dialect.decimal,
                             scan->at, scan->err);
}

static bool numbers_without_names(TextScan *scan) {
    return bad_line(scan, "begins numbers that no header names — name them with --columns "
                          "theta,phi,..., or say --table theta-down or phi-down for a matrix");
}

/* The first row of numbers: of which layout is it? */
static bool begin_rows(TextScan *scan) {
    bool is_matrix = scan->options->layout >= LAYOUT_THETA_DOWN;
    if (is_matrix && scan->count > 1) return begin_block(scan);
    if (scan->has_header && !scan->blocks.count) {
        scan->state = STATE_LIST;
        return add_list_row(scan);
    }
    return numbers_without_names(scan);
}

static bool add_block_row(TextScan *scan) {
    TextBlocks *blocks = &scan->blocks;
    int wanted = blocks->across + 1;
    bool has_final = scan->count == wanted + 1 && !scan->cell[wanted].length;
    if (scan->count != wanted && !has_final)
        return bad_line(scan,
                        "has %d cells, required: %d as the head of the "
                        "matrix",
                        scan->count, wanted);
    double *value = text_blocks_row(blocks, scan->at, scan->err);
    if (!value) return false;
    for (int i = 0; i < wanted; i++)
        if (!read_cell(scan, scan->cell[i], &value[i]))
            return bad_cell(scan, scan->cell[i], i ? "matrix" : "angle");
    if (isnan(value[0])) return bad_cell(scan, scan->cell[0], "angle");
    return true;
}

/* A row may also hold text, in columns that are not used. */
static bool begins_row(const TextScan *scan) {
    int first = scan->has_header && scan->state != STATE_BLOCK ? scan->table->column[0].from : 0;
    return first < scan->count && is_number(scan, scan->cell[first]);
}

static bool read_text_line(TextScan *scan, TextLine line) {
    bool begins_with_number = begins_row(scan);
    if (scan->state == STATE_BEFORE && begins_with_number && scan->has_header &&
        !scan->blocks.count && scan->count == scan->header_cells)
        return begin_rows(scan);
    if (scan->state == STATE_LIST) {
        if (begins_with_number) return add_list_row(scan);
        scan->state = STATE_DONE;
    }
    if (scan->state == STATE_BLOCK) {
        if (begins_with_number) return add_block_row(scan);
        scan->state = STATE_BEFORE;
    }
    bool is_open = scan->state == STATE_BEFORE && !scan->options->columns;
    if (is_open && is_matrix_head(scan) && scan->options->layout != LAYOUT_LIST)
        return begin_block(scan);
    bool is_header = has_direction(scan->cell, scan->count) ||
                     (!scan->has_header && has_section(scan->cell, scan->count));
    if (is_open && !scan->blocks.count && is_header)
        return read_header(scan, scan->cell, scan->count, false);
    if (is_open && text_blocks_label(&scan->blocks, scan->cell, scan->count)) return true;
    if (is_open && scan->has_header && !scan->blocks.count && scan->count == scan->header_cells)
        return bad_line(scan, "stands between the header and its numbers — leave it out with "
                              "--comment, and say the units it may hold with --unit and "
                              "--angle-unit");
    text_metadata_read_line(scan->metadata, line, scan->at);
    return true;
}

static bool read_row(TextScan *scan) {
    switch (scan->state) {
    case STATE_LIST: return add_list_row(scan);
    case STATE_BLOCK: return add_block_row(scan);
    case STATE_BEFORE: return begin_rows(scan);
    case STATE_DONE: break;
    }
    return bad_line(scan, "holds numbers again behind the end of the table");
}

static bool read_line(TextScan *scan) {
    TextLine line = scan->text->line[scan->at];
    int comment = comment_length(scan, line);
    if (comment) {
        TextLine rest = {line.text + comment, line.length - comment};
        text_metadata_read_line(scan->metadata, rest, scan->at);
        return true;
    }
    scan->count = text_cells(line, scan->dialect.delimiter, scan->cell);
    if (scan->count < 0) return bad_line(scan, "has more than %d cells", TEXT_CELLS_MAX);
    bool is_empty = true;
    for (int i = 0; i < scan->count; i++) is_empty &= !scan->cell[i].length;
    if (is_empty) {
        if (scan->state == STATE_BLOCK) scan->state = STATE_BEFORE;
        return true;
    }
    return is_row(scan, scan->cell, scan->count) ? read_row(scan) : read_text_line(scan, line);
}

bool text_scan(const char *file, const TextOptions *options, Arena *arena, NamedRows *out,
               TextMetadata *metadata, Error *err) {
    TextFile text;
    if (!text_file_read(file, options->encoding, arena, &text, err)) return false;
    *out = (NamedRows){0};
    *metadata = text_metadata();
    TextScan scan = {.text = &text,
                     .options = options,
                     .dialect = options->dialect,
                     .arena = arena,
                     .err = err,
                     .metadata = metadata,
                     .table = out,
                     .cell = ARENA_NEW(arena, TextCell, TEXT_CELLS_MAX)};
    scan.blocks = (TextBlocks){.text = &text, .options = options, .arena = arena};
    if (!text_find_dialect(&text, options->skip_lines, *arena, &scan.dialect, err)) return false;
    if (options->columns && !read_users_columns(&scan)) return false;
    for (scan.at = options->skip_lines; scan.at < text.count; scan.at++)
        if (!read_line(&scan)) return false;
    if (scan.blocks.count && !text_blocks_finish(&scan.blocks, out, err)) return false;
    return out->rows.count > 0 || error_at(err, ERROR_INPUT, file, "", "has no row of numbers");
}
