/* SPDX-License-Identifier: Apache-2.0 */
/* request_levels.h -- how bright the displays are set: "levels".
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_fields.h"

bool request_levels_read(RequestReading *reading, Error *err);

/* One of each member, a display's name or "*", from the view's arena. */
bool request_levels_fixed(const FieldMembers *members, ReviewFixedLevel **out, Error *err);

/* The levels under "levels" of any object; none: *count is 0. */
bool request_levels_of(const JsonView *view, ReviewLevel **out, int *count, Error *err);
