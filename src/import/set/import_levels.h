/* SPDX-License-Identifier: Apache-2.0 */
/* import_levels.h -- a measured gamma table beside a set of white alone.
 *
 * Units    cd m^-2. Memory: the set's arena. Threads: one at a time.
 * Fails    with the table's file and line (panel/set/level_table.h), or when the set is not of
 *          white alone.
 */
#pragma once
#include "import/set/import.h"

/* Reads the table, holds it against the set's white and keeps it in the set. */
bool import_levels(const char *file, ImportSet *set, Error *err);
