/* SPDX-License-Identifier: Apache-2.0 */
/* specular_table.h -- readings of a panel's mirror by a reflectometer or a gloss meter: the
 * share of the light that comes back within an aperture around the mirror direction.
 *
 * Between its incidences reflectance over Fresnel's (index 1.5) is linear, beyond them it is
 * held; along the wavelengths it is linear and held.
 *
 * Gloss     a gloss unit is a hundredth of what polished black glass of index 1.567 mirrors at
 *           the meter's angle. The meters' receptors (20, 60, 85 degrees) are slits; here they
 *           are round ones of the same solid angle, and one value serves all wavelengths: an
 *           approximation.
 * Units     radians, nm, reflectances of 1. Memory: the arena's. Threads: const once read.
 * Fails     with file, line or JSON path, found and required.
 */
#pragma once
#include "record/record.h"

#define SPECULAR_APERTURE_MOST_DEG 30.0

typedef struct SpecularTable {
    const char *file; /* the table's, or the manifest's */
    bool is_gloss;
    int rows, wavelengths;
    const double *incidence; /* radians, rising */
    const double *aperture;  /* per row: full angle, radians; 0: the mirror alone */
    const double *nm;        /* rising */
    const double *value;     /* rows x wavelengths */
} SpecularTable;

/* Columns incidence (or theta), wavelength (or nm; without it: all of them) and reflectance,
 * degrees and nm, rows in any order, every incidence at every wavelength. */
bool specular_table_read_file(const char *file, double aperture_deg, Arena *arena,
                              SpecularTable *out, Error *err);

#define GLOSS_METERS 3 /* 20, 60 and 85 degrees */

typedef struct GlossReading {
    double geometry_deg, gu;
} GlossReading;

/* Readings of gloss meters, each geometry once. */
typedef struct Gloss {
    int count;
    GlossReading reading[GLOSS_METERS];
} Gloss;

/* Adds one; the error's text follows the name of the reading's source. */
bool specular_gloss_add(Gloss *gloss, double geometry_deg, double gu, Error *err);

/* The key `gloss` of a document, a list of GlossReading; and what its rows cannot say. */
extern const RecordFormat gloss_format;
bool specular_gloss_collect(const JsonView *view, const GlossReading *list, int count, Gloss *out,
                            Error *err);

/* file: for messages later. */
void specular_table_from_gloss(const Gloss *gloss, const char *file, Arena *arena,
                               SpecularTable *out);

/* The key `specular` of a manifest: a table's path, or that with the aperture. */
typedef struct SpecularFile {
    const char *file; /* NULL: there is none */
    double aperture_deg;
} SpecularFile;

extern const RecordRow specular_forms[];

/* The file again, as specular_table_read_file reads it. */
const char *specular_table_text(const SpecularTable *table, Arena *arena);

/* At an incidence and wavelength; *aperture is that of the nearest row. */
double specular_table_at(const SpecularTable *table, double incidence, double nm, double *aperture);
