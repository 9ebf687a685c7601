/* SPDX-License-Identifier: Apache-2.0 */
#include "review/route/route_gpx.h"

#include <libxml/parser.h>
#include <libxml/tree.h>
#include <stdio.h>
#include <string.h>

#include "text/xml_tags.h"

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

bool route_gpx_read(const char *text, RoutePoints *points, Error *err)
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
