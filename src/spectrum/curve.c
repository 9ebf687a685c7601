/* SPDX-License-Identifier: Apache-2.0 */
#include "spectrum/curve.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "spectrum/curve_header.h"
#include "spectrum/spectral_table.h"

#define MAX_POINTS 4096 /* 0.1 nm over the visible range */
#define VALUE_MAX 1e12

void curve_from_points(const double *nm, const double *value, int count, Curve *out) {
    int next = 0; /* first point at or above the nanometre */
    for (int i = 0; i < CURVE_COUNT; i++) {
        double here = CURVE_FIRST_NM + i;
        while (next < count && nm[next] < here) next++;
        if (next == 0) out->value[i] = (float)value[0];
        else if (next == count) out->value[i] = (float)value[count - 1];
        else {
            double t = (here - nm[next - 1]) / (nm[next] - nm[next - 1]);
            out->value[i] = (float)(value[next - 1] + t * (value[next] - value[next - 1]));
        }
    }
}

#define SLACK_NM 1.0 /* wavelengths are rounded */

bool curve_reaches(double first_nm, double last_nm, CurveEnds dark) {
    return (dark.first || first_nm <= CURVE_SEEN_FIRST_NM + SLACK_NM) &&
           (dark.last || last_nm >= CURVE_SEEN_LAST_NM - SLACK_NM);
}

double curve_beyond(double first_nm, double last_nm, CurveEnds dark) {
    double all = 0, beyond = 0;
    bool below = !dark.first && first_nm > CURVE_WHOLE_FIRST_NM + SLACK_NM;
    bool above = !dark.last && last_nm < CURVE_WHOLE_LAST_NM - SLACK_NM;
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        double nm = SPECTRAL_FIRST_NM + i, v = (double)spectral_table[i].y;
        all += v;
        if ((below && nm < first_nm) || (above && nm > last_nm)) beyond += v;
    }
    return beyond / all;
}

CurveEnds curve_dark_ends(const double *value, int count, double share) {
    double most = 0;
    for (int i = 0; i < count; i++) most = fmax(most, fabs(value[i]));
    return (CurveEnds){fabs(value[0]) <= share * most, fabs(value[count - 1]) <= share * most};
}

#define COLUMNS_MAX 2 /* beside the wavelength */

typedef struct Points {
    double nm[MAX_POINTS], value[COLUMNS_MAX][MAX_POINTS];
    int count, columns;
    CurveRange range; /* of one column */
    CurveHeader header;
} Points;

/* Nothing but white space from here on? */
static bool is_blank(const char *text) {
    while (*text == ' ' || *text == '\t' || *text == '\r' || *text == '\n') text++;
    return *text == '\0';
}

/* As many numbers as the header names, with a comma, semicolon or white space between, the
 * same in all of the row; out: as nm, then values, in the units that are asked for. */
static bool parse_row(const char *line, const Points *points, double out[1 + COLUMNS_MAX]) {
    char between[1 + COLUMNS_MAX] = {0};
    double number[1 + COLUMNS_MAX];
    int last = points->columns;
    for (int i = 0; i <= last; i++) {
        while (*line == ' ' || *line == '\t') line++;
        const char *end = number_read(line, &number[i]);
        if (!end) return false;
        while (*end == ' ' || *end == '\t') end++;
        if (i < last && (*end == ',' || *end == ';')) between[i] = *end++;
        if (i && i < last && between[i] != between[i - 1]) return false;
        line = end;
    }
    for (int i = 0; i <= last; i++)
        out[i] = number[points->header.place[i]] * (i ? points->header.value : points->header.nm);
    return is_blank(line);
}

/* Of a line that is no row: a comma between digits may be the reason, unless commas part
 * numbers with points, or a word is it. */
static const char *comma_hint(const char *line) {
    if ((strchr(line, '.') && !strchr(line, ';')) || line[strspn(line, " \t\r+-.,;0123456789eE")])
        return "";
    for (const char *at = strchr(line, ','); at; at = strchr(at + 1, ','))
        if (at > line && isdigit((unsigned char)at[-1]) && isdigit((unsigned char)at[1]))
            return " — a decimal comma? Required are decimal points";
    return "";
}

static bool check_value(const Points *points, const char *path, const char *place,
                        const double *number, Error *err) {
    double nm = number[0], value = number[1];
    if (!(nm > 0 && nm < 1e6 && fabs(value) <= VALUE_MAX))
        return error_at(err, ERROR_INPUT, path, place,
                        "wavelength %g nm with value %g: required: finite numbers, nm above 0, "
                        "up to %g",
                        nm, value, VALUE_MAX);
    bool is_low = points->range != CURVE_NUMBERS && value < 0;
    bool is_high = points->range == CURVE_SHARES && value > 1;
    return !is_low && !is_high
               ? true
               : error_at(err, ERROR_INPUT, path, place, "holds %.9g; %s is required", value,
                          points->range == CURVE_SHARES ? "0 to 1" : "0 or more");
}

static bool check_values(const Points *points, const char *path, const char *place,
                         const double *number, Error *err) {
    double nm = number[0], n = number[1], k = number[2];
    if (points->columns == 1) return check_value(points, path, place, number, err);
    bool is_index = n >= 0 && n <= INDEX_MAX && k >= 0 && k <= INDEX_MAX && n + k > 0;
    return nm > 0 && nm < 1e6 && is_index
               ? true
               : error_at(err, ERROR_INPUT, path, place,
                          "wavelength %g nm with n %g and k %g: required: nm above 0, n and k from "
                          "0 to %g, not both 0",
                          nm, n, k, INDEX_MAX);
}

static bool add_row(Points *points, const char *path, const char *place, const double *number,
                    Error *err) {
    int n = points->count;
    double nm = number[0];
    if (!check_values(points, path, place, number, err)) return false;
    if (n && !(nm > points->nm[n - 1]))
        return error_at(err, ERROR_INPUT, path, place,
                        "wavelength %g nm after %g nm: required: rising wavelengths", nm,
                        points->nm[n - 1]);
    if (n == MAX_POINTS)
        return error_at(err, ERROR_INPUT, path, place, "more than %d rows", MAX_POINTS);
    points->nm[n] = nm;
    for (int i = 0; i < points->columns; i++) points->value[i][n] = number[1 + i];
    points->count++;
    return true;
}

/* Copies a line of text, or as much of it as fits, and returns what follows it. */
static const char *next_line(const char *text, char *line, size_t size) {
    size_t length = strcspn(text, "\n");
    snprintf(line, size, "%.*s", (int)(length < size ? length : size - 1), text);
    return text + length + (text[length] == '\n');
}

#define DARK_END 1e-3 /* of the largest value */

/* Light that has ended does not come back; a filter's share may. */
static CurveEnds dark_ends(const Points *points) {
    if (points->columns > 1 || points->range != CURVE_AMOUNTS) return (CurveEnds){false, false};
    return curve_dark_ends(points->value[0], points->count, DARK_END);
}

/* Wavelengths in um or m, or of an invisible range, would give the same value everywhere. */
static bool check_reach(const Points *points, const char *path, Error *err) {
    double first = points->nm[0], last = points->nm[points->count - 1];
    const char *unit = first > 0.1 && last < 20 ? " — in micrometres? Required are nm" : "";
    return curve_reaches(first, last, dark_ends(points)) ||
           error_at(err, ERROR_INPUT, path, NULL,
                    "holds wavelengths from %g to %g nm, "
                    "required from %d to %d nm or beyond%s%s",
                    first, last, CURVE_SEEN_FIRST_NM, CURVE_SEEN_LAST_NM,
                    points->range == CURVE_AMOUNTS && points->columns == 1
                        ? ", but where light has ended"
                        : "",
                    unit);
}

static double beyond_of(const Points *points) {
    return curve_beyond(points->nm[0], points->nm[points->count - 1], dark_ends(points));
}

/* Numbers that are too few or too many are no names of columns. */
static bool is_header(const char *line) {
    return !strchr("+-.0123456789", line[strspn(line, " \t")]);
}

static bool take_header(const char *line, const char *path, const char *place, Points *points,
                        Error *err) {
    const char *why =
        curve_header_read(line, 1 + points->columns,
                          points->columns == 1 && points->range == CURVE_AMOUNTS, &points->header);
    return !why ||
           error_at(err, ERROR_INPUT, path, place, "its header \"%.60s\" states %s", line, why);
}

/* A comment before the first row that names as many columns is their header too. */
static bool take_comment(const char *line, const char *path, const char *place, Points *points,
                         Error *err) {
    CurveHeader found;
    line += strspn(line, "# \t");
    curve_header_read(line, 1 + points->columns, true, &found);
    return !found.names_wavelength || take_header(line, path, place, points, err);
}

/* One line may be a header: the first that is neither blank nor a comment. */
static bool read_points(const char *text, const char *path, Points *points, Error *err) {
    char line[512], place[32];
    bool may_be_header = true;
    const char *names = points->columns == 1 ? "two numbers: nm,value" : "three numbers: nm,n,k";
    points->header = curve_header_none();
    if (strncmp(text, "\xef\xbb\xbf", 3) == 0) text += 3; /* an editor's mark of UTF-8 */
    for (int row = 1; *text; row++) {
        double number[1 + COLUMNS_MAX] = {0};
        text = next_line(text, line, sizeof line);
        line[strcspn(line, "\r\n")] = '\0';
        snprintf(place, sizeof place, "line %d", row);
        if (is_blank(line)) continue;
        if (line[0] == '#') {
            if (may_be_header && !take_comment(line, path, place, points, err)) return false;
            continue;
        }
        if (parse_row(line, points, number)) {
            if (!add_row(points, path, place, number, err)) return false;
        } else if (!may_be_header || !is_header(line)) {
            return error_at(err, ERROR_INPUT, path, place,
                            "found \"%.60s\", required: "
                            "%s%s",
                            line, names, comma_hint(line));
        } else if (!take_header(line, path, place, points, err)) {
            return false;
        }
        may_be_header = false;
    }
    if (!points->count)
        return error_at(err, ERROR_INPUT, path, NULL, "no rows of %s", strstr(names, "nm"));
    return check_reach(points, path, err);
}

/* NULL: refused; else to be freed. */
static Points *read_file(const char *text, const char *path, int columns, CurveRange range,
                         CurveNotes *notes, Error *err) {
    Points *points = calloc(1, sizeof *points);
    if (!points) error_at(err, ERROR_MEMORY, path, NULL, "no memory to read it");
    if (!points) return NULL;
    points->columns = columns;
    points->range = range;
    if (!read_points(text, path, points, err)) {
        free(points);
        return NULL;
    }
    if (notes) notes->beyond = beyond_of(points);
    if (notes) memcpy(notes->unknown, points->header.unknown, sizeof notes->unknown);
    return points;
}

bool curve_parse(const char *text, const char *path, CurveRange range, Curve *out,
                 CurveNotes *notes, Error *err) {
    Points *points = read_file(text, path, 1, range, notes, err);
    if (points) curve_from_points(points->nm, points->value[0], points->count, out);
    bool ok = points != NULL;
    free(points);
    return ok;
}

bool curve_parse_index(const char *text, const char *path, Curve *n, Curve *k, CurveNotes *notes,
                       Error *err) {
    Points *points = read_file(text, path, 2, CURVE_NUMBERS, notes, err);
    if (points) curve_from_points(points->nm, points->value[0], points->count, n);
    if (points) curve_from_points(points->nm, points->value[1], points->count, k);
    bool ok = points != NULL;
    free(points);
    return ok;
}

Spectrum curve_lookup(const Curve *curve, const Wavelengths *wavelengths) {
    Spectrum place = wavelengths->nm - spectrum_all(CURVE_FIRST_NM), low, high;
    SpectrumMask cell = __builtin_convertvector(place, SpectrumMask);
    cell -= 1 + ((cell - (CURVE_COUNT - 1)) >> 31); /* the last wavelength ends the last cell */
    spectrum_neighbours(curve->value, cell, &low, &high);
    return low + (high - low) * (place - __builtin_convertvector(cell, Spectrum));
}
