/* SPDX-License-Identifier: Apache-2.0 */
/* request_conditions.h -- under which light: "conditions". Eyes, symbols, withs and levels are
 * read already.
 *
 * Fails    as request_read.h.
 */
#pragma once
#include "review/request/request_reading.h"

bool request_conditions_read(RequestReading *reading, Error *err);
