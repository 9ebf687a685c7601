/* SPDX-License-Identifier: Apache-2.0 */
/* request_light.h -- the "environment" of a condition, which is read as a scene's is.
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_reading.h"

/* view: of condition i, whose time and heading are read already. */
bool request_light_read(RequestReading *reading, const JsonView *view, int i,
                        ReviewCondition *condition, Error *err);
