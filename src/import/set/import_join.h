/* SPDX-License-Identifier: Apache-2.0 */
/* import_join.h -- tables of a set compared and joined by their directions.
 *
 * Two rows stand at the same direction when both angles agree within SAME_ANGLE_DEG.
 *
 * Memory   the set's arena. Threads: one set per thread.
 */
#pragma once
#include "import/set/import.h"

/* Do both hold the same component, or the same wavelengths? */
bool import_same_channels(const ImportTable *a, const ImportTable *b);

/* For each row of `table` the row of `other` at the same direction, or -1; from the arena. */
int *import_match_rows(const ImportTable *table, const ImportTable *other, Arena *arena);

/* The channels of `count` tables (indices into the set) side by side, at the directions that
 * all of them have; by rising wavelength for reflection. */
bool import_join_tables(ImportSet *set, const int *part, int count, ImportTable *joined,
                        Error *err);

/* The rows of `count` tables one after the other. */
void import_append_tables(ImportSet *set, const int *part, int count, ImportTable *joined);

/* Removes the tables of the list but `keep`, or all of a source. */
void import_remove_tables(ImportSet *set, const int *part, int count, int keep);
void import_remove_source(ImportSet *set, ImportSource source);

/* A direction that stands more than once in a table becomes the mean of its values; theta 0
 * is left alone. */
void import_merge_directions(ImportSet *set);
