/* SPDX-License-Identifier: Apache-2.0 */
/* request_weather.h -- the "weather" of a route or a year: clear, or a file of every hour.
 *
 * Gaps in a file are the sweep's question, which knows the hours that count.
 *
 * Fails    as request_read.h; a weather file with its own name and line.
 */
#pragma once
#include "review/request/request_reading.h"

/* "clear" or absent: NO_ID; else the file's place among the request's weathers. */
bool request_weather_read(RequestReading *reading, const JsonView *view, int *weather_id,
                          Error *err);
