/* SPDX-License-Identifier: Apache-2.0 */
#include "review/route/route_csv.h"

#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "text/nearest_word.h"

enum { COLUMN_TIME, COLUMN_LAT, COLUMN_LON, COLUMN_HEADING, COLUMN_ALTITUDE, COLUMNS };

#define LINE_CELLS_MAX 16

static const char *const NAMES[COLUMNS] = {"time", "lat", "lon", "heading", "altitude_m"};

typedef struct CsvRoute {
    RoutePoints *points;
    char        *next; /* rest of the text; NULL at the end */
    int          line;
    int          column[LINE_CELLS_MAX]; /* what each cell of a line is */
    int          columns;
} CsvRoute;

static bool fails(const CsvRoute *in, Error *err, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool fails(const CsvRoute *in, Error *err, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    error_at_count(err, in->points->file, "line", in->line, format, list);
    va_end(list);
    return false;
}

/* ---- lines and cells --------------------------------------------------------------------- */

static char *trim(char *text)
{
    text += strspn(text, " \t\r");
    size_t length = strlen(text);
    while (length && strchr(" \t\r", text[length - 1])) text[--length] = 0;
    return text;
}

/* The next line that holds something; NULL at the end. */
static char *next_line(CsvRoute *in)
{
    while (in->next) {
        char *line = in->next, *feed = strchr(line, '\n');
        in->next = feed ? feed + 1 : NULL;
        if (feed) *feed = 0;
        in->line++;
        if (line[strspn(line, " \t\r")] && *trim(line) != '#') return line;
    }
    return NULL;
}

/* Cuts a line into cells; how many there are, of which LINE_CELLS_MAX at most are kept. */
static int cut(char *line, char *cell[LINE_CELLS_MAX])
{
    int count = 0;
    for (char *at = line; at; count++) {
        char *begin = at;
        at = strpbrk(at, ",;\t");
        if (at) *at++ = 0;
        if (count < LINE_CELLS_MAX) cell[count] = trim(begin);
    }
    return count;
}

/* ---- header and rows --------------------------------------------------------------------- */

static int column_of(const char *name)
{
    for (int i = 0; i < COLUMNS; i++)
        if (!strcmp(NAMES[i], name)) return i;
    return -1;
}

static bool read_header(CsvRoute *in, Error *err)
{
    char *cell[LINE_CELLS_MAX], *line = next_line(in);
    bool  seen[COLUMNS] = {false};
    if (!line)
        return error_at(err, ERROR_INPUT, in->points->file, "",
                        "is empty, wanted a header line time,lat,lon,heading and points");
    in->columns = cut(line, cell);
    if (in->columns > LINE_CELLS_MAX)
        return fails(in, err, "has %d columns, wanted time,lat,lon,heading", in->columns);
    for (int i = 0; i < in->columns; i++) {
        int column = column_of(cell[i]);
        if (column < 0)
            return fails(in, err,
                         "has a column '%.40s', wanted time,lat,lon,heading,altitude_m; the "
                         "nearest is '%s'", cell[i], nearest_word(cell[i], NAMES, COLUMNS));
        if (seen[column]) return fails(in, err, "has the column '%s' twice, wanted it once",
                                       NAMES[column]);
        seen[column] = true;
        in->column[i] = column;
    }
    for (int i = COLUMN_TIME; i <= COLUMN_LON; i++)
        if (!seen[i])
            return fails(in, err, "has no column '%s', wanted time,lat,lon,heading", NAMES[i]);
    return true;
}

static bool read_row(CsvRoute *in, char *line, Error *err)
{
    char       *cell[LINE_CELLS_MAX];
    const char *text[COLUMNS] = {NULL};
    int         cells = cut(line, cell);
    if (cells != in->columns)
        return fails(in, err, "has %d cells, wanted the header's %d", cells, in->columns);
    for (int i = 0; i < cells; i++) text[in->column[i]] = cell[i];
    return route_points_add(in->points,
                            &(RouteText){text[COLUMN_LAT], text[COLUMN_LON], text[COLUMN_TIME],
                                         text[COLUMN_ALTITUDE], text[COLUMN_HEADING], in->line},
                            err);
}

bool route_csv_read(const char *text, RoutePoints *points, Error *err)
{
    CsvRoute in = {.points = points, .next = arena_string(points->arena, text, strlen(text))};
    if (!read_header(&in, err)) return false;
    for (char *line = next_line(&in); line; line = next_line(&in))
        if (!read_row(&in, line, err)) return false;
    return points->count > 0 ||
           error_at(err, ERROR_INPUT, points->file, "", "has a header line but no points");
}
