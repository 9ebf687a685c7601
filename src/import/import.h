/* import.h -- files that laboratories have, as one measurement set of this project.
 *
 * An importer reads one foreign file and adds the tables that it holds to an ImportSet, in this
 * project's conventions; import_write writes the set as MANIFEST.json and its tables.
 *
 * Frame     degrees, as in the files: theta from the normal, phi 0 right (the viewer's), 90 up,
 *           counter-clockwise. In a reflection table phi counts from the mirror direction: the
 *           light comes from 180 (leaving azimuth + 180 - the light's azimuth).
 * Units     XYZ in cd m^-2; BRDF in sr^-1 without the cosine; nm.
 * Memory    the arena's. Threads: one set per thread.
 * Fails     with the file, the line or the place inside it, what was found and what was wanted.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

#define IMPORT_TABLES_MAX 4096

typedef enum ImportSource {
    IMPORT_RED, IMPORT_GREEN, IMPORT_BLUE, IMPORT_BLACK, IMPORT_WHITE, /* emission: XYZ */
    IMPORT_REFLECTION /* a channel a wavelength */
} ImportSource;

typedef struct ImportTable {
    ImportSource  source;
    const char   *file;              /* where it comes from */
    double        level;             /* emission: grey level, (0, 255]; of black and white: 0, 255 */
    double        incidence_deg;     /* reflection: [0, 90) */
    double        incidence_phi_deg; /* reflection: the light's azimuth, [0, 360); 180: isotropic
                                        data, or the only azimuth measured */
    int           rows, channels;    /* channels: 3 (X, Y, Z), or wavelength_count */
    const float  *wavelength_nm;     /* reflection: channels of them, rising */
    const double *theta_deg, *phi_deg; /* rows */
    const double *value;             /* rows x channels */
    int           masked;            /* directions that the file marks as not measured: left out */
} ImportTable;

typedef struct ImportSet {
    Arena       *arena;
    ImportTable *table;              /* room for IMPORT_TABLES_MAX */
    int          count;
    bool         is_anisotropic;     /* reflection depends on the light's azimuth */
    const char  *panel, *instrument; /* names for the manifest; NULL: the file's */
    const char  *note[64];           /* one line each: what was assumed, converted, left out */
    int          note_count;
} ImportSet;

ImportSet import_set(Arena *arena);

/* Copies the table's fields (not its arrays) into the set. */
bool import_add(ImportSet *set, const ImportTable *table, Error *err);
void import_note(ImportSet *set, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Writes the tables beside MANIFEST.json (folders emission/ and brdf/), then the manifest; checks
 * first that the tables make a set (red, green and blue or white; every incidence with the same
 * wavelengths; a full grid of incidences and azimuths). Nothing half-written stays. */
bool import_write(const ImportSet *set, const char *manifest, Error *err);

/* ---- what the user declared ---------------------------------------------------------------- */

typedef struct ImportOptions {
    const char *format;      /* name of an importer; NULL: told by the file itself */
    double      wavelength_nm; /* for files that do not say; 0: not given */
    double      area_mm[2];  /* luminous area for luminaire files; 0: the file's */
    const void *text;        /* the text importer's declaration (import_text.h); NULL: none */
} ImportOptions;

/* One importer: `recognises` looks at the first bytes (and the name); `read` adds the tables. */
typedef struct Importer {
    const char *name;    /* for --format: "zemax", "mountain", "klems", ... */
    const char *summary; /* one line for --help */
    bool (*recognises)(const char *file, const char *head, size_t head_size);
    bool (*read)(const char *file, const ImportOptions *options, ImportSet *set, Error *err);
} Importer;

/* All importers, in the order in which they are asked; ends with a NULL name. */
extern const Importer *const importers[];
