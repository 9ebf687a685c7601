/* SPDX-License-Identifier: Apache-2.0 */
/* request_eyes.h -- who looks, where to, and at what: "eyes", "forward", "observer", "gaze" and
 * "symbols"; who else is there: "with".
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_fields.h"

bool request_eyes_read(RequestReading *reading, Error *err);
bool request_symbols_read(RequestReading *reading, Error *err);
bool request_withs_read(RequestReading *reading, Error *err);

/* A polarity under a key; absent: *out keeps its value. */
bool request_polarity_read(const JsonView *view, const char *key, ReviewPolarity *out,
                           Error *err);
