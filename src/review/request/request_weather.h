/* request_weather.h -- the "weather" of a route or a year: clear, or a file of every hour.
 *
 * Fails    as request_read.h; a weather file that has gaps or no whole year with its own name
 *          and line.
 */
#pragma once
#include "review/request/request_reading.h"

/* "clear" or absent: NO_ID; else the file's place among the request's weathers. */
bool request_weather_read(RequestReading *reading, const JsonView *view, int *weather_id,
                          Error *err);
