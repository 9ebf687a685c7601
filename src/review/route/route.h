/* SPDX-License-Identifier: Apache-2.0 */
/* route.h -- a drive or a flight: where the vehicle is at which time and where it points.
 *
 * Formats  GPX 1.0 and 1.1: <trkpt lat lon> with <ele> and <time>, segments and tracks one
 *          after the other. CSV: a header line `time,lat,lon,heading`, in any order; `heading`
 *          and `altitude_m` may be missing, and their cells be empty. Times are ISO 8601 with
 *          their zone, and do not fall.
 * Heading  where the file gives none, the bearing of the great circle to the next point;
 *          standing still (less than a metre) keeps the last one, and before the first move
 *          there is the first. The earth is a sphere here: within 0.2 degrees of the
 *          ellipsoid's.
 * Memory   the arena's. Threads: const once read.
 * Fails    ERROR_INPUT with file and line, what was found and what was required.
 */
#pragma once
#include "review/route/route_points.h"

typedef struct Route {
    const char *file;
    RoutePoint *points;
    int         count; /* at least 1 */
} Route;

/* GPX when it begins with '<', else CSV. */
bool route_read(const char *file, Arena *arena, Route *out, Error *err);

/* Moves all times so that the first point is passed then, in that zone. */
void route_start_at(Route *route, const SkyTime *when);

/* Bearing at the first point of the great circle to the second, degrees in [0, 360). */
double route_bearing_deg(const SkyPlace *from, const SkyPlace *to);
