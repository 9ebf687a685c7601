/* SPDX-License-Identifier: Apache-2.0 */
/* route_csv.h -- the points of a route from a table: a header line, then a line a point.
 *
 * Columns  time, lat, lon wanted; heading and altitude_m may be missing, and their cells empty.
 *          Commas, semicolons or tabs between cells; # comments and empty lines are skipped.
 * Threads  no shared state. Fails: as route_points.h.
 */
#pragma once
#include "review/route/route_points.h"

bool route_csv_read(const char *text, RoutePoints *points, Error *err);
