/* SPDX-License-Identifier: Apache-2.0 */
/* request_levels.h -- how bright the displays are set: "levels", "max_level".
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_fields.h"

bool request_levels_read(RequestReading *reading, Error *err);

/* Times as bright: one of each member, a display's name or "*", from the view's arena. */
bool request_brightness_read(const FieldMembers *members, ReviewFixedLevel **out, Error *err);

/* The levels under "levels" of any object, none above `most`; none: *count is 0. */
bool request_levels_of(const JsonView *view, double most, ReviewLevel **out, int *count,
                       Error *err);
