/* import_parts.h -- what the set's completion works with: tables joined by their directions.
 *
 * Memory   the set's arena. Threads: one set per thread.
 */
#pragma once
#include "import/set/import.h"

/* Angles nearer than this are the same one, degrees. */
#define SAME_ANGLE_DEG 1e-4

/* "red", "black", "reflection". */
const char *import_source_name(ImportSource source);

/* The channels of `count` tables (indices into the set) side by side, at the directions that
 * all of them have; by rising wavelength for reflection. */
bool import_join_tables(ImportSet *set, const int *part, int count, ImportTable *joined,
                        Error *err);

/* The rows of `count` tables one after the other. */
void import_append_tables(ImportSet *set, const int *part, int count, ImportTable *joined);

/* Removes the tables of the list but `keep`. */
void import_remove_tables(ImportSet *set, const int *part, int count, int keep);

/* For each row of `table` the row of `other` at the same direction, or -1; from the arena. */
int *import_match_rows(const ImportTable *table, const ImportTable *other, Arena *arena);

/* Subtracts what was read without light and divides signals by the white reference's; then
 * both leave the set. */
bool import_apply_references(ImportSet *set, Error *err);

/* Luminance alone as X, Y, Z: the chromaticity of the primaries' spectra, or that of D65. */
void import_add_colour(ImportSet *set, ImportTable *table);

/* Fills directions and lights by the set's symmetry. */
bool import_mirror(ImportSet *set, Error *err);

/* Notes how far a measured white is from the sum of the primaries. */
void import_note_white(ImportSet *set);

/* A direction that stands more than once in a table becomes the mean of its values; theta 0
 * is left alone. */
void import_merge_directions(ImportSet *set);
