/* SPDX-License-Identifier: Apache-2.0 */
/* primary_spectra.h -- the relative spectra of a display's primaries from a table.
 *
 * Units    nm; values relative. Memory: the arena's. Threads: any number.
 * Fails    with the file, its line, what was found and what was required.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "spectrum/spectral_table.h"

/* One primary's column; nm rising. */
typedef struct PrimaryColumn {
    const char *file, *name;
    const double *nm, *value;
    int count;
} PrimaryColumn;

/* From 400 to 700 nm, but where the light has ended. *beyond rises to the share of V(lambda)
 * where light was not measured (spectrum/curve.h). */
bool primary_spectrum_reaches(const PrimaryColumn *column, double *beyond, Error *err);

/* Columns nm, red, green, blue and maybe black: linear between the measured wavelengths, 0
 * outside; every nm from SPECTRAL_FIRST_NM. *beyond, 0 before: as above, of all. */
bool primary_spectra_read(const char *file, Arena *arena, float spectrum[3][SPECTRAL_COUNT],
                          double *beyond, Error *err);
