/* SPDX-License-Identifier: Apache-2.0 */
/* route_gpx.h -- the track points of a GPX file.
 *
 * Source   GPX 1.0 and 1.1 (topografix.com): gpx / trk / trkseg / trkpt with the attributes lat
 *          and lon, degrees of WGS 84, and the elements ele (m) and time (ISO 8601, UTC).
 * Threads  no shared state.
 * Fails    as route_points.h; no network, no document type, no entities.
 */
#pragma once
#include "review/route/route_points.h"

bool route_gpx_read(const char *text, RoutePoints *points, Error *err);
