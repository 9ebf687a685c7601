/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_lines.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/number.h"
#include "print/utf8.h"
#include "import/set/import.h"

#define CELL_DIGITS_MAX 60
#define DEGREE_SIGN "\xC2\xB0"
#define LINES_MAX (INT_MAX / 2)

/* ---- characters -------------------------------------------------------------------------- */

/* Writes one character as UTF-8; blanks and minus signs of typographers become plain ones. */
static char *put_character(char *to, unsigned code) {
    if (code == 0xA0 || code == 0x2007 || code == 0x202F || code == 0x1A || !code) code = ' ';
    if (code == 0x2212) code = '-';
    return to + utf8_encode(code, to);
}

static TextEncoding find_encoding(const unsigned char *bytes, size_t size, size_t *mark) {
    *mark = 0;
    if (size >= 2 && bytes[0] == 0xFF && bytes[1] == 0xFE) return *mark = 2, ENCODING_UTF16LE;
    if (size >= 2 && bytes[0] == 0xFE && bytes[1] == 0xFF) return *mark = 2, ENCODING_UTF16BE;
    if (size >= 3 && !memcmp(bytes, "\xEF\xBB\xBF", 3)) return *mark = 3, ENCODING_UTF8;
    return ENCODING_UTF8;
}

/* One UTF-16 character, with its surrogate if there is one; returns the bytes taken. */
static size_t utf16_character(const unsigned char *at, size_t left, bool is_big, unsigned *code) {
    int high = is_big ? 0 : 1;
    *code = (unsigned)at[high] << 8 | at[1 - high];
    if (*code >> 10 != 0x36 || left < 4) return 2;
    unsigned low = (unsigned)at[2 + high] << 8 | at[3 - high];
    if (low >> 10 != 0x37) return 2;
    *code = 0x10000 + ((*code & 0x3FF) << 10 | (low & 0x3FF));
    return 4;
}

static char *decode(const unsigned char *bytes, size_t size, TextEncoding encoding, char *to) {
    unsigned code = 0;
    for (size_t i = 0; i < size;) {
        if (encoding == ENCODING_UTF16LE || encoding == ENCODING_UTF16BE) {
            if (size - i < 2) break;
            i += utf16_character(bytes + i, size - i, encoding == ENCODING_UTF16BE, &code);
        } else {
            int length = encoding == ENCODING_UTF8
                             ? utf8_decode((const char *)bytes + i, size - i, &code)
                             : 0;
            if (!length) code = bytes[i]; /* Latin-1, or a broken byte of UTF-8 */
            i += length ? (size_t)length : 1;
        }
        to = put_character(to, code);
    }
    return to;
}

/* ---- lines ------------------------------------------------------------------------------- */

static size_t count_character(const char *text, const char *end, char wanted) {
    size_t count = 0;
    while ((text = memchr(text, wanted, (size_t)(end - text)))) {
        count++;
        text++;
    }
    return count;
}

static bool cut_lines(const char *text, const char *end, Arena *arena, TextFile *out, Error *err) {
    char feed = memchr(text, '\n', (size_t)(end - text)) ? '\n' : '\r';
    size_t count = count_character(text, end, feed) + 1;
    if (count > LINES_MAX)
        return error_at(err, ERROR_INPUT, out->file, "",
                        "has %zu lines, required: "
                        "fewer",
                        count);
    out->line = ARENA_NEW(arena, TextLine, count);
    while (text < end) {
        const char *stop = memchr(text, feed, (size_t)(end - text));
        const char *next = stop ? stop + 1 : end;
        if (!stop) stop = end;
        while (stop > text && (stop[-1] == '\r' || stop[-1] == ' ')) stop--;
        if (stop - text > INT_MAX)
            return error_at(err, ERROR_INPUT, out->file, text_place(out->count, arena),
                            "is too long for a line of text");
        out->line[out->count++] = (TextLine){text, (int)(stop - text)};
        text = next;
    }
    return true;
}

bool text_file_decode(const char *file, FileBytes bytes, TextEncoding encoding, Arena *arena,
                      TextFile *out, Error *err) {
    size_t mark;
    TextFile text = {.file = file};
    TextEncoding found = find_encoding(bytes.data, bytes.size, &mark);
    if (encoding == ENCODING_AUTO) encoding = found;
    if (encoding == ENCODING_UTF8 && memchr(bytes.data, 0, bytes.size < 512 ? bytes.size : 512))
        return error_at(err, ERROR_INPUT, file, "",
                        "holds zero bytes, as UTF-16 without its mark — say --encoding utf-16le "
                        "or utf-16be");
    char *decoded = ARENA_NEW(arena, char, 2 * (bytes.size - mark) + 1);
    char *end = decode(bytes.data + mark, bytes.size - mark, encoding, decoded);
    if (!cut_lines(decoded, end, arena, &text, err)) return false;
    *out = text;
    return true;
}

bool text_file_read(const char *file, TextEncoding encoding, Arena *arena, TextFile *out,
                    Error *err) {
    FileBytes bytes;
    return file_read(file, IMPORT_FILE_BYTES_MAX, arena, &bytes, err) &&
           text_file_decode(file, bytes, encoding, arena, out, err);
}

const char *text_place(int line_index, Arena *arena) {
    return arena_format(arena, "line %d", line_index + 1);
}

/* ---- cells ------------------------------------------------------------------------------- */

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

static TextCell trimmed(const char *begin, const char *end) {
    while (begin < end && is_blank(*begin)) begin++;
    while (end > begin && is_blank(end[-1])) end--;
    if (end - begin >= 2 && *begin == '"' && end[-1] == '"')
        return (TextCell){begin + 1, (int)(end - begin - 2)};
    return (TextCell){begin, (int)(end - begin)};
}

/* Where the cell that begins here ends: a delimiter inside quotes is no end. */
static const char *cell_end(const char *at, const char *end, char delimiter) {
    const char *first = at;
    while (first < end && *first == ' ') first++;
    if (first < end && *first == '"') {
        const char *quote = memchr(first + 1, '"', (size_t)(end - first - 1));
        if (quote) at = quote + 1;
    }
    const char *stop = memchr(at, delimiter, (size_t)(end - at));
    return stop ? stop : end;
}

static int cells_between_blanks(TextLine line, TextCell *cell) {
    const char *at = line.text, *end = line.text + line.length;
    int count = 0;
    for (;;) {
        while (at < end && is_blank(*at)) at++;
        if (at == end) return count;
        if (count == TEXT_CELLS_MAX) return -1;
        const char *begin = at;
        while (at < end && !is_blank(*at)) at++;
        cell[count++] = trimmed(begin, at);
    }
}

int text_cells(TextLine line, char delimiter, TextCell *cell) {
    if (delimiter == ' ') return cells_between_blanks(line, cell);
    const char *at = line.text, *end = line.text + line.length;
    for (int count = 0;;) {
        const char *stop = cell_end(at, end, delimiter);
        if (count == TEXT_CELLS_MAX) return -1;
        cell[count++] = trimmed(at, stop);
        if (stop == end) return count;
        at = stop + 1;
    }
}

bool text_number(TextCell cell, char decimal, double *out) {
    char plain[CELL_DIGITS_MAX + 1];
    bool has_digit = false;
    if (cell.length > 2 && !memcmp(cell.text + cell.length - 2, DEGREE_SIGN, 2)) cell.length -= 2;
    if (cell.length < 1 || cell.length > CELL_DIGITS_MAX) return false;
    for (int i = 0; i < cell.length; i++) {
        char c = cell.text[i];
        bool is_decimal = c == decimal;
        if (!isdigit((unsigned char)c) && !is_decimal && !strchr("+-eE", c)) return false;
        if (is_decimal && decimal == ',' &&
            (i + 1 == cell.length || !isdigit((unsigned char)cell.text[i + 1])))
            return false;
        has_digit |= isdigit((unsigned char)c) != 0;
        plain[i] = is_decimal ? '.' : c;
    }
    plain[cell.length] = 0;
    if (!has_digit) return false;
    return number_is(plain, out);
}

bool text_is_masked(TextCell cell) {
    static const char *const words[] = {"nan",     "n/a",  "na",       "#n/a",      "null",
                                        "none",    "-nan", "nan(ind)", "-nan(ind)", "1.#qnan",
                                        "-1.#ind", "inf",  NULL};
    bool only_marks = true;
    for (int i = 0; i < cell.length; i++) only_marks &= strchr("-*?", cell.text[i]) != NULL;
    for (int i = 0; words[i] && !only_marks; i++)
        only_marks = (int)strlen(words[i]) == cell.length &&
                     !strncasecmp(words[i], cell.text, (size_t)cell.length);
    return only_marks;
}

/* ---- which delimiter, which decimal sign ------------------------------------------------- */

#define DIALECT_LINES 4000

/* At least two numbers, and nothing else but masks; or, when a column may hold words, at least
 * three that are the better half. */
static bool is_numeric_row(const TextCell *cell, int count, char decimal, bool with_words) {
    int numbers = 0, words = 0;
    double value;
    for (int i = 0; i < count; i++) {
        if (text_number(cell[i], decimal, &value)) numbers++;
        else words += !text_is_masked(cell[i]);
    }
    return with_words ? numbers >= 3 && numbers > words : numbers >= 2 && !words;
}

static int count_rows(const TextFile *text, int first_line, TextDialect dialect, bool with_words,
                      TextCell *cell) {
    int rows = 0, seen = 0;
    for (int i = first_line; i < text->count && seen < DIALECT_LINES; i++) {
        if (!text->line[i].length) continue;
        int count = text_cells(text->line[i], dialect.delimiter, cell);
        seen++;
        rows += count > 1 && is_numeric_row(cell, count, dialect.decimal, with_words);
    }
    return rows;
}

/* The dialect of the most rows; how many they are. Decimal commas between commas stand in
 * quotes. */
static int best_dialect(const TextFile *text, int first_line, bool with_words, TextCell *cell,
                        TextDialect *dialect) {
    static const char delimiters[] = ";\t, ", decimals[] = ".,";
    TextDialect best = *dialect;
    int most = 0;
    for (const char *d = delimiters; *d; d++)
        for (const char *p = decimals; *p; p++) {
            bool wanted = (!dialect->delimiter || dialect->delimiter == *d) &&
                          (!dialect->decimal || dialect->decimal == *p);
            int rows =
                wanted ? count_rows(text, first_line, (TextDialect){*d, *p}, with_words, cell) : 0;
            if (rows <= most) continue;
            most = rows;
            best = (TextDialect){*d, *p};
        }
    *dialect = best;
    return most;
}

bool text_find_dialect(const TextFile *text, int first_line, Arena scratch, TextDialect *dialect,
                       Error *err) {
    TextCell *cell = ARENA_NEW(&scratch, TextCell, TEXT_CELLS_MAX);
    if (best_dialect(text, first_line, false, cell, dialect) ||
        best_dialect(text, first_line, true, cell, dialect))
        return true;
    return error_at(err, ERROR_INPUT, text->file, "",
                    "has no row of numbers%s — say how they are written with --delimiter and "
                    "--decimal, or name the file's --format",
                    dialect->delimiter || dialect->decimal ? " as declared" : "");
}
