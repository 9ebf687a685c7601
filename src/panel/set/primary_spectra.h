/* SPDX-License-Identifier: Apache-2.0 */
/* primary_spectra.h -- the relative spectra of a display's primaries from a table, held against
 * the XYZ that were measured of the same primaries.
 *
 * Units    nm; values relative. Memory: the arena's. Threads: any number.
 * Fails    with the file, its line, what was found and what was required.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "panel/set/measured.h"
#include "spectrum/twice.h"
#include "text/csv_table.h"

/* One primary's column; nm rising. */
typedef struct PrimaryColumn {
    const char *file, *name;
    const double *nm, *value;
    int count;
} PrimaryColumn;

/* From 400 to 700 nm, but where the light has ended. *beyond rises to the share of V(lambda)
 * where light was not measured (spectrum/curve.h). */
bool primary_spectrum_reaches(const PrimaryColumn *column, double *beyond, Error *err);

/* Columns of wavelength (nm, wavelength, wavelength_nm), red, green, blue (R, G, B) and maybe black
 * (K; else -1), in any case and order; wavelengths rise. */
#define PRIMARY_COLUMNS 5
bool primary_columns_read(const char *file, Arena *arena, CsvTable *csv,
                          int column[PRIMARY_COLUMNS], Error *err);

/* Of such a table's primaries: linear between the measured wavelengths, 0
 * outside; every nm from SPECTRAL_FIRST_NM. *beyond, 0 before: as above, of all. */
bool primary_spectra_read(const char *file, Arena *arena, float spectrum[3][SPECTRAL_COUNT],
                          double *beyond, Error *err);

/* ---- measured twice ---------------------------------------------------------------------- */

/* delta u'v' between a spectrum and a table: what two calibrated instruments differ by. */
#define PRIMARY_APART_UV 0.01

/* The three by their spectra and by their tables. */
typedef struct PrimaryColours {
    const char *file;      /* of the spectra */
    double spectrum[3][3]; /* XYZ, any scale */
    double table[3][3];    /* XYZ of full level along the normal, without black */
} PrimaryColours;

/* Refuses columns that have another primary's colour. */
bool primary_colours_check(const PrimaryColours *colours, Error *err);

/* XYZ of a primary's level nearest to the normal, without black. False: it has no light there,
 * and Rec.709's stand in for it. */
bool primary_colour(const Measurement *set, int p, int level, double xyz[3]);

/* The same of a set, whose primaries must have been measured. */
bool primary_spectra_check(const Measurement *set, const char *file, Error *err);

/* The primary whose spectrum and table are furthest apart; false: not both were measured. */
bool primary_twice(const Measurement *set, Twice *worst);
