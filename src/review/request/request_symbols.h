/* SPDX-License-Identifier: Apache-2.0 */
/* request_symbols.h -- what is read and who else is there: "symbols" and "with"; the words of a
 * polarity.
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_reading.h"

bool request_symbols_read(RequestReading *reading, Error *err);
bool request_withs_read(RequestReading *reading, Error *err);

/* A polarity under a key; absent: *out keeps its value. */
bool request_polarity_read(const JsonView *view, const char *key, ReviewPolarity *out,
                           Error *err);
