/* SPDX-License-Identifier: Apache-2.0 */
#include "review/route/route.h"

#include <libxml/parser.h>
#include <libxml/tree.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "review/route/route_points.h"
#include "text/xml_tags.h"
#include "text/xml_text.h"

/* The track points of a GPX file.
 *
 * Source   GPX 1.0 and 1.1 (topografix.com): gpx / trk / trkseg / trkpt with the attributes lat
 *          and lon, degrees of WGS 84, and the elements ele (m) and time (ISO 8601, UTC).
 * Threads  no shared state.
 * Fails    as route_points.h; no network, no document type, no entities. */

/* ---- elements ---------------------------------------------------------------------------- */

static bool is_named(const xmlNode *node, const char *name)
{
    return node->type == XML_ELEMENT_NODE && !strcmp((const char *)node->name, name);
}

/* A copy in the arena, blanks around it removed; takes the text. NULL for NULL. */
static const char *keep(Arena *arena, xmlChar *text)
{
    if (!text) return NULL;
    const char *begin = (const char *)text + strspn((const char *)text, " \t\r\n");
    size_t      length = strlen(begin);
    while (length && strchr(" \t\r\n", begin[length - 1])) length--;
    const char *kept = arena_string(arena, begin, length);
    xmlFree(text);
    return kept;
}

static const char *child_text(Arena *arena, const xmlNode *node, const char *name)
{
    for (xmlNode *child = node->children; child; child = child->next)
        if (is_named(child, name)) return keep(arena, xmlNodeGetContent(child));
    return NULL;
}

/* ---- tracks ------------------------------------------------------------------------------ */

typedef struct GpxReader {
    RoutePoints *points;
    Arena        scratch; /* for one point's texts */
} GpxReader;

static bool read_point(const GpxReader *reader, const xmlNode *node, Error *err)
{
    Arena     scratch = reader->scratch;
    RouteText text = {.lat = keep(&scratch, xmlGetProp(node, (const xmlChar *)"lat")),
                      .lon = keep(&scratch, xmlGetProp(node, (const xmlChar *)"lon")),
                      .time = child_text(&scratch, node, "time"),
                      .altitude = child_text(&scratch, node, "ele"),
                      .line = (int)xmlGetLineNo(node)};
    return route_points_add(reader->points, &text, err);
}

static bool read_segment(const GpxReader *reader, const xmlNode *segment, Error *err)
{
    for (xmlNode *node = segment->children; node; node = node->next)
        if (is_named(node, "trkpt") && !read_point(reader, node, err)) return false;
    return true;
}

static bool read_track(const GpxReader *reader, const xmlNode *track, Error *err)
{
    for (xmlNode *node = track->children; node; node = node->next)
        if (is_named(node, "trkseg") && !read_segment(reader, node, err)) return false;
    return true;
}

static bool read_document(const GpxReader *reader, xmlDoc *document, Error *err)
{
    const char *file = reader->points->file;
    xmlNode    *root = xmlDocGetRootElement(document);
    if (!root || !is_named(root, "gpx"))
        return error_at(err, ERROR_INPUT, file, "",
                        "holds an element '%.40s', required: a GPX file's 'gpx'",
                        root ? (const char *)root->name : "");
    for (xmlNode *node = root->children; node; node = node->next)
        if (is_named(node, "trk") && !read_track(reader, node, err)) return false;
    return reader->points->count > 0 ||
           error_at(err, ERROR_INPUT, file, "",
                    "has no track point, required: trk / trkseg / trkpt");
}

/* ---- opening ----------------------------------------------------------------------------- */

/* Without a document type nothing can be fetched, and nothing expands. */
static bool check_type(const char *text, const char *file, Error *err)
{
    return !strstr(text, "<!DOCTYPE") ||
           error_at(err, ERROR_INPUT, file, "",
                    "has a document type (<!DOCTYPE), which is not taken");
}

static xmlDoc *parse(const char *text, const char *file, Error *err)
{
    int options = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE |
                  XML_PARSE_NOCDATA | XML_PARSE_BIG_LINES | XML_PARSE_IGNORE_ENC;
    xmlParserCtxt *context = xmlNewParserCtxt();
    if (!context) {
        error_at(err, ERROR_MEMORY, file, "", "out of memory");
        return NULL;
    }
    xmlDoc *document = xmlCtxtReadMemory(context, text, (int)strlen(text), file, "UTF-8",
                                         options);
    const xmlError *problem = xmlCtxtGetLastError(context);
    if (!document) {
        const char *why = problem && problem->message ? problem->message : "is not XML";
        char        place[32] = "";
        if (problem && problem->line) snprintf(place, sizeof place, "line %d", problem->line);
        error_at(err, ERROR_INPUT, file, place, "is no sound XML: %.*s, required: a GPX file",
                 (int)strcspn(why, "\r\n"), why);
    }
    xmlFreeParserCtxt(context);
    return document;
}

static bool route_gpx_read(const char *text, RoutePoints *points, Error *err)
{
    if (!check_type(text, points->file, err) || !xml_tags_check(text, points->file, err))
        return false;
    xmlDoc *document = parse(text, points->file, err);
    if (!document) return false;
    GpxReader reader = {points, arena_reserve(ROUTE_BYTES_MAX)};
    bool      ok = read_document(&reader, document, err);
    arena_release(&reader.scratch);
    xmlFreeDoc(document);
    return ok;
}

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
