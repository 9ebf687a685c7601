/* SPDX-License-Identifier: Apache-2.0 */
/* request_sweep.h -- the "sweep" of a condition: over the sun's direction, or over a year.
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_reading.h"

/* view: of the sweep. Sets the condition's kind and what belongs to it. */
bool request_sweep_read(RequestReading *reading, const JsonView *view,
                        ReviewCondition *condition, Error *err);
