/* SPDX-License-Identifier: Apache-2.0 */
#include "review/route/route_points.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"
#include "text/nearest_word.h"

static bool fails(const RoutePoints *points, int line, Error *err, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static bool fails(const RoutePoints *points, int line, Error *err, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    error_at_count(err, points->file, "line", line, format, list);
    va_end(list);
    return false;
}

static bool is_given(const char *text)
{
    return text && *text;
}

/* A number of the file: its name there, the text, the range. */
typedef struct RouteNumber {
    const char *name, *text;
    double      low, high;
} RouteNumber;

static bool parse_number(const RoutePoints *points, int line, RouteNumber number, double *out,
                         Error *err)
{
    char  *after = NULL;
    double value = is_given(number.text) ? strtod(number.text, &after) : 0;
    if (!is_given(number.text))
        return fails(points, line, err, "the point has no %s, required: a number from %g to %g",
                     number.name, number.low, number.high);
    if (after == number.text || *after || !(value >= number.low && value <= number.high))
        return fails(points, line, err, "%s is '%.40s', required: a number from %g to %g",
                     number.name, number.text, number.low, number.high);
    *out = value;
    return true;
}

static bool parse_time(const RoutePoints *points, const RouteText *text, SkyTime *out,
                       Error *err)
{
    Error why;
    if (!is_given(text->time))
        return fails(points, text->line, err,
                     "the point has no time, required: a moment such as 2026-06-21T08:30:15Z");
    return sky_time_parse(text->time, "", out, &why) ||
           fails(points, text->line, err, "time: %s", why.text);
}

/* From one moment to another. Julian days alone are only good to 0.04 ms at this epoch; whole
 * days apart, at noon, are exact. */
static double seconds_between(SkyTime from, SkyTime to)
{
    SkyTime day[2] = {{from.year, from.month, from.day, 12, 0, 0, 0},
                      {to.year, to.month, to.day, 12, 0, 0, 0}};
    double days = sky_julian_day(&day[1]) - sky_julian_day(&day[0]);
    double hours = 24 * days + (to.hour - from.hour) - (to.zone_h - from.zone_h);
    return 3600 * hours + 60 * (to.minute - from.minute) + (to.second - from.second);
}

/* The seconds since the first point, which must not fall. */
static bool follow(const RoutePoints *points, RoutePoint *point, Error *err)
{
    if (!points->count) return true;
    const RoutePoint *first = &points->list[0], *last = &points->list[points->count - 1];
    point->seconds = seconds_between(first->when, point->when);
    return point->seconds >= last->seconds ||
           fails(points, point->line, err,
                 "the time lies %.0f s before that of line %d, required: times that do not "
                 "fall",
                 last->seconds - point->seconds, last->line);
}

static bool parse(const RoutePoints *points, const RouteText *text, RoutePoint *out, Error *err)
{
    const RouteNumber lat = {"lat", text->lat, -90, 90};
    const RouteNumber lon = {"lon", text->lon, -180, 180};
    const RouteNumber altitude = {"altitude", text->altitude, -500, 60000};
    const RouteNumber heading = {"heading", text->heading, -360, 360};
    RoutePoint point = {.line = text->line, .has_heading = is_given(text->heading)};
    if (!parse_number(points, text->line, lat, &point.where.latitude_deg, err) ||
        !parse_number(points, text->line, lon, &point.where.longitude_deg, err) ||
        (is_given(text->altitude) &&
         !parse_number(points, text->line, altitude, &point.where.altitude_m, err)) ||
        (point.has_heading &&
         !parse_number(points, text->line, heading, &point.heading_deg, err)) ||
        !parse_time(points, text, &point.when, err) || !follow(points, &point, err))
        return false;
    point.heading_deg = fmod(point.heading_deg + 360, 360);
    *out = point;
    return true;
}

bool route_points_add(RoutePoints *points, const RouteText *text, Error *err)
{
    RoutePoint point;
    if (points->count == ROUTE_POINTS_MAX)
        return fails(points, text->line, err, "is a point too many, required: at most %d",
                     ROUTE_POINTS_MAX);
    if (!parse(points, text, &point, err)) return false;
    if (points->count == points->capacity) {
        points->capacity = 2 * points->capacity + 64;
        points->list = ARENA_GROW(points->arena, RoutePoint, points->list, points->count,
                                  points->capacity);
    }
    points->list[points->count++] = point;
    return true;
}

/* ---- from a table ------------------------------------------------------------------------ */

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
                        "is empty, required: a header line time,lat,lon,heading and points");
    in->columns = cut(line, cell);
    if (in->columns > LINE_CELLS_MAX)
        return fails(in->points, in->line, err, "has %d columns, required: "
                     "time,lat,lon,heading",
                     in->columns);
    for (int i = 0; i < in->columns; i++) {
        int column = column_of(cell[i]);
        if (column < 0)
            return fails(in->points, in->line, err,
                         "has a column '%.40s', required: time,lat,lon,heading,altitude_m; the "
                         "nearest is '%s'", cell[i], nearest_word(cell[i], NAMES, COLUMNS));
        if (seen[column])
            return fails(in->points, in->line, err,
                         "has the column '%s' twice, required: once", NAMES[column]);
        seen[column] = true;
        in->column[i] = column;
    }
    for (int i = COLUMN_TIME; i <= COLUMN_LON; i++)
        if (!seen[i])
            return fails(in->points, in->line, err,
                         "has no column '%s', required: time,lat,lon,heading", NAMES[i]);
    return true;
}

static bool read_row(CsvRoute *in, char *line, Error *err)
{
    char       *cell[LINE_CELLS_MAX];
    const char *text[COLUMNS] = {NULL};
    int         cells = cut(line, cell);
    if (cells != in->columns)
        return fails(in->points, in->line, err, "has %d cells, required: the header's "
                     "%d", cells,
                     in->columns);
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
