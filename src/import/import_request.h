/* SPDX-License-Identifier: Apache-2.0 */
/* import_request.h -- everything that a user requests of an import, on the command line or in a
 * file of options that a laboratory writes once.
 *
 * Memory   texts from the arena or the caller's. Threads: one at a time.
 * Fails    with the file, the JSON path, what was found and what was required.
 */
#pragma once
#include "import/set/import.h"
#include "import/text/text_options.h"
#include "panel/set/specular_table.h"
#include "record/record.h"

/* A reflectometer's table, or gloss meters' readings, of the reflection: degrees, nm,
 * reflectances of 1, gloss units. File NULL and no gloss: nothing is added. */
typedef struct ImportSpecular {
    const char *file;
    double aperture_deg; /* full angle; 0: the mirror alone */
    Gloss gloss;
} ImportSpecular;

/* Called with the number of files done. */
typedef void ImportStep(void *context, int done);

/* Spectra of the primaries: a column of wavelengths, one each for red, green and blue, and one
 * for black if it was measured. Fails with the file, the line, what was found and required. */
bool primaries_read(const char *file, ImportSet *set, Error *err);

typedef struct ImportRequest {
    TextOptions text;
    ImportOptions options;   /* options.text is set by import_run */
    TextList skip;           /* patterns of files to leave out */
    const char *primaries;   /* a file of spectra; NULL: none */
    const char *levels;      /* a gamma table of a white-only set; NULL: none */
    ImportSpecular specular; /* of a reflection */
    const char *root;        /* --root: where else such a file may name files; or NULL */
    const char *panel, *instrument, *date, *operator_name, *conditions, *backlight;
    double instrument_fwhm_deg; /* 0: not stated */
    double peaks_nm[3];         /* 0: not stated */
    const GlossReading *gloss;  /* as a file has it; specular.gloss counts */
    int gloss_count;
    ImportSymmetry symmetry;
    bool is_isotropic, black_is_zero, accepts_repeats;
    ImportStep *step; /* NULL: nobody waits */
    void *context;
} ImportRequest;

extern const RecordFormat import_format;

/* Reads a file of options (README: its keys) into a request, whose root is set already. */
bool import_request_read(const char *file, Arena *arena, ImportRequest *request, Error *err);

/* "none", "left-right", "up-down", "both", "half-turn". */
bool import_symmetry_named(const char *name, ImportSymmetry *out, Error *err);

/* Is the file left out, by a pattern of the list or by its role? */
bool import_request_skips(const ImportRequest *request, const char *file);

/* Reads all files with the options of the request and completes the set. */
bool import_run(const char *const *file, int count, const ImportRequest *request, ImportSet *set,
                Error *err);
