/* SPDX-License-Identifier: Apache-2.0 */
/* measurement.h -- reads and checks what a laboratory measured of one display.
 *
 * Memory   the arena's.
 * Fails    with file, line or JSON path, found and required.
 */
#pragma once
#include "panel/set/measured.h"

/* Reads MANIFEST.json and every table it names; a path that ends in .csv is one white-only
 * table (theta, phi and X, Y, Z or Y, x, y). Tables lie below the parent of the manifest's
 * folder. */
bool measurement_read(const char *path, Arena *arena, Measurement *out, Error *err);

/* The same; tables may also lie below `folder` (--root). NULL: no such folder. */
bool measurement_read_below(const char *path, const char *folder, Arena *arena, Measurement *out,
                            Error *err);

/* Gives a set of white alone the levels of a gamma table (level_table.h), in place of what it
 * had. level_max: its highest code (0: as in level_table.h). Its full level, unless relative,
 * must be within LEVEL_TABLE_FULL_MISS of white nearest to the normal (compared up to 10
 * degrees from it). On failure the set stays as it was. */
bool measurement_read_levels(Measurement *set, const char *file, double level_max, Arena *arena,
                             Error *err);
