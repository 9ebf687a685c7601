/* SPDX-License-Identifier: Apache-2.0 */
/* speos_binary.h -- the binary form of Speos' .anisotropicbsdf, known from one public file of
 * version 9.0: every field that is not understood must have the value that it has there.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    with the file and the byte.
 */
#pragma once
#include "import/set/import.h"

/* ---- a table ---------------------------------------------------------------------------- */

/* What a Speos scatter file holds, from its text or its binary form.
 *
 * Frame     phi 0 is the mirror direction ("the theoretical specular direction is always
 *           (theta_i, 0)"); an anisotropy angle is the azimuth from the mirror direction to the
 *           anisotropy vector, which is taken as this project's phi 0. Degrees.
 * Memory    the arena's. Threads: const once read. */

typedef struct SpeosTable {
    double anisotropy_deg, incidence_deg;
    double nm, percent; /* of a .brdf: wavelength and reflectance of this table */
    int thetas, phis;
    double *theta_deg, *phi_deg, *value; /* value: phis x thetas, proportional to the BRDF */
} SpeosTable;

typedef struct Speos {
    const char *file;
    bool has_reflection, has_transmission;
    bool is_bsdf;     /* false: values hold the cosine of the leaving angle */
    bool is_spectral; /* .brdf: a table a wavelength; else a spectrum scales them all */
    int tables;
    SpeosTable *table;
    double spectrum_theta_deg, spectrum_phi_deg; /* where the spectrum was measured */
    int spectrum_count;
    double *spectrum_nm, *spectrum_percent;
} Speos;

#define SPEOS_ANGLES_MAX 4096
#define SPEOS_TABLES_MAX 4096

/* Fills table->value from rows, down in theta as the files have them, and checks that the
 * angles rise and are in range. */
bool speos_table_fill(const char *file, SpeosTable *table, const double *rows, Arena *arena,
                      Error *err);

bool speos_binary_read(const char *file, Arena *arena, Speos *out, Error *err);
