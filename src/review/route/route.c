/* SPDX-License-Identifier: Apache-2.0 */
#include "review/route/route.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "review/route/route_gpx.h"
#include "review/route/route_points.h"
#include "text/xml_text.h"

#define EARTH_M 6371008.8 /* mean radius (IUGG) */
#define STANDING_M 1.0

/* ---- headings ---------------------------------------------------------------------------- */

/* Great circle from a to b on the sphere: with latitudes p, q and the longitudes' difference l,
 *     tan(bearing) = sin l cos q / (cos p sin q - sin p cos q cos l). */
double route_bearing_deg(const SkyPlace *from, const SkyPlace *to)
{
    double p = radians_from_degrees(from->latitude_deg);
    double q = radians_from_degrees(to->latitude_deg);
    double l = radians_from_degrees(to->longitude_deg - from->longitude_deg);
    double bearing = degrees_from_radians(
        atan2_d(sin_d(l) * cos_d(q), cos_d(p) * sin_d(q) - sin_d(p) * cos_d(q) * cos_d(l)));
    return fmod(bearing + 360, 360);
}

/* By the haversine, which keeps small distances exact. */
static double distance_m(const SkyPlace *from, const SkyPlace *to)
{
    double p = radians_from_degrees(from->latitude_deg);
    double q = radians_from_degrees(to->latitude_deg);
    double l = radians_from_degrees(to->longitude_deg - from->longitude_deg);
    double up = sin_d((q - p) / 2), along = sin_d(l / 2);
    return 2 * EARTH_M * asin_d(fmin(1, sqrt(up * up + cos_d(p) * cos_d(q) * along * along)));
}

/* Sets the heading of points [first, last), unless the file gives their own. */
static void set_headings(RoutePoint *points, int first, int last, double heading_deg)
{
    for (int i = first; i < last; i++)
        if (!points[i].has_heading) points[i].heading_deg = heading_deg;
}

/* Between the point that was left and the next one a metre away the vehicle stands: it keeps
 * its heading until the last of them, from where it goes on. False: it never moves. */
static bool find_headings(RoutePoint *points, int count)
{
    int    left = 0;
    bool   has_moved = false;
    double heading = 0;
    for (int i = 1; i < count; i++) {
        if (distance_m(&points[left].where, &points[i].where) < STANDING_M) continue;
        double next = route_bearing_deg(&points[left].where, &points[i].where);
        set_headings(points, left, i - 1, has_moved ? heading : next);
        set_headings(points, i - 1, i, next);
        has_moved = true;
        heading = next;
        left = i;
    }
    set_headings(points, left, count, heading);
    return has_moved;
}

/* Headings that the file leaves out follow from movement, so some points must move. */
static bool fill_headings(const RoutePoints *points, Error *err)
{
    bool has_moved = find_headings(points->list, points->count), is_said = true;
    for (int i = 0; i < points->count; i++) is_said &= points->list[i].has_heading;
    return has_moved || is_said ||
           error_at(err, ERROR_INPUT, points->file, "",
                    "never moves, so that no heading follows; required: a column 'heading', or "
                    "points more than %g m apart", STANDING_M);
}

/* ---- reading ----------------------------------------------------------------------------- */

bool route_read(const char *file, Arena *arena, Route *out, Error *err)
{
    FileBytes   bytes;
    const char *text;
    RoutePoints points = {.file = arena_string(arena, file, strlen(file)), .arena = arena};
    if (!file_read(file, ROUTE_BYTES_MAX, arena, &bytes, err)) return false;
    bool ok = xml_text_is(&bytes)
                  ? xml_text_read(points.file, &bytes, arena, &text, err) &&
                        route_gpx_read(text, &points, err)
                  : file_text(points.file, &bytes, &text, err) &&
                        route_csv_read(text, &points, err);
    if (!ok || !fill_headings(&points, err)) return false;
    *out = (Route){points.file, points.list, points.count};
    return true;
}

/* ---- times ------------------------------------------------------------------------------- */

void route_start_at(Route *route, const SkyTime *when)
{
    for (int i = 0; i < route->count; i++)
        route->points[i].when = sky_time_later(*when, route->points[i].seconds);
}
