/* SPDX-License-Identifier: Apache-2.0 */
/* record_schema.h -- a format's rows as JSON Schema (2020-12).
 *
 * What a format's `check` refuses beyond its `rules` no schema says: the program is stricter.
 *
 * Memory   the caller releases the document. Threads: pure. Fails: NULL without memory.
 */
#pragma once
#include "record/record.h"

/* title: of the whole file. */
json_t *record_schema(const RecordFormat *format, const char *title);
