/* SPDX-License-Identifier: Apache-2.0 */
#include "text/point_rows.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/number.h"

#define FILE_BYTES_MAX ((size_t)1 << 30)
#define COLUMNS 6
#define REQUIRED "required X Y Z NX NY NZ"

static const char *const NAMES[COLUMNS] = {"x", "y", "z", "nx", "ny", "nz"};

bool point_row_set(const double values[6], FacingPoint *out) {
    const double *n = values + 3;
    double most = fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
    if (!(most > 0)) return false;
    double x = n[0] / most, y = n[1] / most, z = n[2] / most;
    double length = sqrt(x * x + y * y + z * z);
    memcpy(out->place, values, sizeof out->place);
    out->normal[0] = x / length;
    out->normal[1] = y / length;
    out->normal[2] = z / length;
    return true;
}

/* ---- words of a line --------------------------------------------------------------------- */

/* A file that is read line by line. */
typedef struct PointLines {
    const char *file, *next, *end;
    int line;
    Arena *arena;
    Error *err;
} PointLines;

/* Up to COLUMNS + 1 of its words, which point into the text. */
typedef struct PointWords {
    const char *begin[COLUMNS + 1];
    int length[COLUMNS + 1], count;
} PointWords;

static bool bad_line(const PointLines *in, const char *what, const char *text, int length) {
    return error_at(in->err, ERROR_INPUT, in->file, arena_format(in->arena, "line %d", in->line),
                    "%s'%.*s', " REQUIRED, what, length < 40 ? length : 40, text);
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

static bool is_mark(char c) {
    return c == ',' || c == ';';
}

/* Between two words one comma or semicolon at most: two would hide a number that is missing. Where
 * commas part some numbers they part all of a line: others may be decimal ones. */
static bool split(const PointLines *in, const char *at, const char *stop, PointWords *out) {
    bool has_comma = false, has_other = false;
    *out = (PointWords){.count = 0};
    for (bool expects = false;;) {
        while (at < stop && is_blank(*at)) at++;
        if (at == stop || *at == '#') return !expects || bad_line(in, "ends with ", ",", 1);
        const char *begin = at;
        if (is_mark(*at)) return bad_line(in, "has no number before ", at, 1);
        while (at < stop && !is_blank(*at) && !is_mark(*at)) at++;
        if (out->count <= COLUMNS) {
            out->begin[out->count] = begin;
            out->length[out->count++] = (int)(at - begin);
        }
        while (at < stop && is_blank(*at)) at++;
        expects = at < stop && is_mark(*at);
        has_comma |= expects && *at == ',';
        has_other |= at < stop && *at != '#' && *at != ',';
        if (has_comma && has_other)
            return bad_line(in,
                            "has commas, and others between its numbers (decimal commas?): ", begin,
                            (int)(stop - begin));
        at += expects;
    }
}

/* The next line with words; false at the end of the file, and after an error. */
static bool next_words(PointLines *in, PointWords *out) {
    while (in->next < in->end) {
        const char *at = in->next;
        const char *feed = memchr(at, '\n', (size_t)(in->end - at));
        const char *stop = feed ? feed : in->end;
        in->next = feed ? feed + 1 : in->end;
        in->line++;
        if (!split(in, at, stop, out)) return false;
        if (out->count) return true;
    }
    return false;
}

/* ---- what they mean ---------------------------------------------------------------------- */

/* A header begins with a letter, and is no "nan" or "inf". */
static bool is_header(const PointWords *words) {
    static const char *const numbers[] = {"nan", "inf"};
    const char *word = words->begin[0];
    for (int i = 0; i < 2; i++)
        if (words->length[0] >= 3 && !strncasecmp(word, numbers[i], 3)) return false;
    return isalpha((unsigned char)*word);
}

static int column_of(const char *word, int length) {
    for (int k = 0; k < COLUMNS; k++)
        if ((int)strlen(NAMES[k]) == length && !strncasecmp(word, NAMES[k], (size_t)length))
            return k;
    return -1;
}

static bool read_header(const PointLines *in, const PointWords *words, int order[COLUMNS]) {
    bool is_there[COLUMNS] = {false};
    for (int i = 0; i < words->count; i++) {
        const char *word = words->begin[i];
        int k = i < COLUMNS ? column_of(word, words->length[i]) : -1;
        if (k < 0) return bad_line(in, "its header names ", word, words->length[i]);
        if (is_there[k]) return bad_line(in, "its header names twice ", word, words->length[i]);
        is_there[k] = true;
        order[i] = k;
    }
    if (words->count == COLUMNS) return true;
    return bad_line(in, "its header ends with ", words->begin[words->count - 1],
                    words->length[words->count - 1]);
}

static bool read_number(const PointLines *in, const char *word, int length, double *out) {
    char text[64];
    if (length >= (int)sizeof text) return bad_line(in, "holds ", word, length);
    memcpy(text, word, (size_t)length);
    text[length] = '\0';
    if ((int)strlen(text) != length) return bad_line(in, "has a zero byte behind ", word, length);
    if (!number_is(text, out) || !(fabs(*out) <= 1e9))
        return bad_line(in, "holds no number up to 1e9, but ", word, length);
    return true;
}

static bool read_point(const PointLines *in, const PointWords *words, const int order[COLUMNS],
                       FacingPoint *out) {
    double values[COLUMNS];
    if (words->count != COLUMNS)
        return error_at(in->err, ERROR_INPUT, in->file,
                        arena_format(in->arena, "line %d", in->line),
                        words->count > COLUMNS ? "has more than 6 numbers, " REQUIRED
                                               : "has %d numbers, " REQUIRED,
                        words->count);
    for (int i = 0; i < COLUMNS; i++)
        if (!read_number(in, words->begin[i], words->length[i], &values[order[i]])) return false;
    return point_row_set(values, out) ||
           error_at(in->err, ERROR_INPUT, in->file, arena_format(in->arena, "line %d", in->line),
                    "the normal (%g, %g, %g) has no direction", values[3], values[4], values[5]);
}

static int count_lines(const PointLines *in) {
    int count = 1;
    for (const char *at = in->next; at < in->end; at++) count += *at == '\n';
    return count;
}

bool point_rows_read(const char *file, Arena *arena, FacingPoint **list, int *count, Error *err) {
    FileBytes bytes;
    PointWords words;
    int order[COLUMNS] = {0, 1, 2, 3, 4, 5};
    bool is_first = true;
    if (!file_read(file, FILE_BYTES_MAX, arena, &bytes, err)) return false;
    bytes = file_unmarked(bytes);
    PointLines in = {.file = file, .next = (const char *)bytes.data, .arena = arena, .err = err};
    in.end = in.next + bytes.size;
    *list = ARENA_NEW(arena, FacingPoint, count_lines(&in));
    *count = 0;
    *err = (Error){0};
    for (; next_words(&in, &words); is_first = false) {
        bool is_names = is_first && is_header(&words);
        if (is_names ? !read_header(&in, &words, order)
                     : !read_point(&in, &words, order, &(*list)[(*count)++]))
            return false;
    }
    if (err->text[0]) return false;
    return *count > 0 || error_at(err, ERROR_INPUT, file, "", "has no points, " REQUIRED " a line");
}
