/* SPDX-License-Identifier: Apache-2.0 */
/* request_levels.h -- how bright the displays are set: "levels".
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_reading.h"

bool request_levels_read(RequestReading *reading, Error *err);

/* The levels under "levels" of any object; none: *count is 0. */
bool request_levels_of(const JsonView *view, ReviewLevel **out, int *count, Error *err);
