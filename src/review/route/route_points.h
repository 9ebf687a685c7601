/* SPDX-License-Identifier: Apache-2.0 */
/* route_points.h -- the points of a route while its file is read: texts become numbers. And
 * those of a table: a header line, then a line a point.
 *
 * Columns  time, lat, lon required; heading and altitude_m may be missing, and their cells
 *          empty. Commas, semicolons or tabs between cells; # comments and empty lines are
 *          skipped.
 * Memory   the arena's. Threads: one at a time.
 * Fails    with the file, the line, the value's name in the file, what was found and required.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "sky/sun_position.h"

#define ROUTE_POINTS_MAX 1000000
#define ROUTE_BYTES_MAX ((size_t)512 << 20)

typedef struct RoutePoint {
    SkyTime  when;
    double   seconds;     /* since the first point */
    SkyPlace where;
    bool     has_heading; /* of the file's own; else it is the bearing */
    double   heading_deg; /* [0, 360), from north over east */
    int      line;        /* of the file */
} RoutePoint;

typedef struct RoutePoints {
    const char *file;
    Arena      *arena;
    RoutePoint *list;
    int         count, capacity;
} RoutePoints;

/* A point as it stands in the file; NULL or "": it has none. */
typedef struct RouteText {
    const char *lat, *lon, *time; /* required */
    const char *altitude, *heading;
    int         line;
} RouteText;

/* Adds a point; its time must not lie before the one of the last. */
bool route_points_add(RoutePoints *points, const RouteText *text, Error *err);

bool route_csv_read(const char *text, RoutePoints *points, Error *err);
