/* SPDX-License-Identifier: Apache-2.0 */
/* synthetic_format.h -- a recipe's keys (record/record.h).
 *
 * Memory   texts live in the arena. Threads: const once read.
 * Fails    with file, JSON path, found and required.
 */
#pragma once
#include "panel/set/synthetic_panel.h"
#include "record/record.h"

extern const RecordFormat synthetic_format; /* of a SyntheticPanel (synthetic_panel.h) */

/* Reads and checks a *.recipe.json. */
bool synthetic_panel_read(const char *file, Arena *arena, SyntheticPanel *out, Error *err);
