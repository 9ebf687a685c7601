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

/* Removes all tables of a source. */
void import_remove_source(ImportSet *set, ImportSource source);

/* XYZ of primary p's spectrum, by the trapezoidal rule over its own wavelengths. */
void import_spectrum_xyz(const ImportSpectra *spectra, int p, double xyz[3]);

/* Joins files that hold parts of one table (sections of one azimuth, one of X, Y and Z, one
 * wavelength), so that every pattern and light has one. Luminance alone gets the chromaticity
 * of the primaries' spectra, or that of D65. Fails with the file that has a part twice or lacks
 * one. */
bool import_join_parts(ImportSet *set, Error *err);

/* A direction that stands more than once in a table becomes the mean of its values; theta 0
 * is left alone. A note says how far they disagree. Unless the set accepts them, it fails where
 * what stands again is all in all another light than what stood first (noise goes out of that
 * sum, two runs of different scale do not), or one direction contradicts itself. */
bool import_merge_directions(ImportSet *set, Error *err);
