/* SPDX-License-Identifier: Apache-2.0 */
/* request_conditions.h -- under which light: "conditions", each with its "environment", which
 * is read as a scene's is, its "sweep" and its "weather". Eyes, symbols, withs and levels are
 * read already. Gaps in a weather file are the sweep's question, which knows the hours that
 * count.
 *
 * Fails    as request_read.h; a weather file with its own name and line.
 */
#pragma once
#include "review/request/request_fields.h"

bool request_conditions_read(RequestReading *reading, Error *err);
