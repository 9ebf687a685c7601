/* SPDX-License-Identifier: Apache-2.0 */
#include "review/route/route_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
        return fails(points, line, err, "the point has no %s, wanted a number from %g to %g",
                     number.name, number.low, number.high);
    if (after == number.text || *after || !(value >= number.low && value <= number.high))
        return fails(points, line, err, "%s is '%.40s', wanted a number from %g to %g",
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
                     "the point has no time, wanted a moment such as 2026-06-21T08:30:15Z");
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
                 "the time lies %.0f s before that of line %d, wanted times that do not fall",
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
        return fails(points, text->line, err, "is a point too many, wanted at most %d",
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
