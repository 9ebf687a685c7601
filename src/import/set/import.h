/* SPDX-License-Identifier: Apache-2.0 */
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
 * Fails     with the file, the line or the place inside it, what was found and what was
 *           required.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "base/lines.h"

#define IMPORT_TABLES_MAX 4096
#define IMPORT_NOTES_MAX 64
#define IMPORT_FILE_BYTES_MAX ((size_t)1 << 30) /* for file_read: no foreign file is larger */
#define IMPORT_ROWS_MAX 8000000                 /* directions of one table */
#define SAME_ANGLE_DEG 1e-4                     /* angles nearer than this are the same one */

typedef enum ImportSource {
    IMPORT_RED,
    IMPORT_GREEN,
    IMPORT_BLUE,
    IMPORT_BLACK,
    IMPORT_WHITE,     /* emission: XYZ */
    IMPORT_REFLECTION /* a channel a wavelength */
} ImportSource;

/* "red", "black", "reflection". */
const char *import_source_name(ImportSource source);

typedef struct ImportTable {
    ImportSource source;
    const char *file;                  /* where it comes from */
    double level;                      /* emission: grey level, (0, 255]; black 0, white 255 */
    double incidence_deg;              /* reflection: [0, 90) */
    double incidence_phi_deg;          /* reflection: the light's azimuth, [0, 360); 180 for
                                          isotropic data, or the only azimuth measured */
    int rows, channels;                /* channels: 3 (X, Y, Z), or wavelength_count */
    char component;                    /* emission: 0, or one of 'X', 'Y', 'Z' with one channel:
                                          files of the same source and level are joined; Y alone
                                          is luminance without colour */
    bool is_section;                   /* directions of one azimuth: sections of the same source
                                          or light are put together */
    const float *wavelength_nm;        /* reflection: channels of them, rising. Tables of the same
                                          light and directions at other wavelengths are joined */
    const double *theta_deg, *phi_deg; /* rows; theta in [0, 90], any phi */
    const double *value;               /* rows x channels */
    int masked;                        /* directions marked as not measured: left out */
    const double *masked_theta_deg, *masked_phi_deg; /* masked of them, or NULL: not known */
} ImportTable;

/* Spectra of the primaries, relative. */
typedef struct ImportSpectra {
    const char *file;
    int rows;               /* 0: none */
    const double *nm;       /* rising */
    const double *value[4]; /* red, green, blue, black (may be NULL) */
} ImportSpectra;

/* The sample's symmetry as the user states it: unmeasured parts are filled from their image. */
typedef enum ImportSymmetry {
    IMPORT_NO_SYMMETRY,
    IMPORT_LEFT_RIGHT,
    IMPORT_UP_DOWN,
    IMPORT_BOTH,
    IMPORT_HALF_TURN
} ImportSymmetry;

typedef struct ImportSet {
    Arena *arena;
    ImportTable *table; /* room for IMPORT_TABLES_MAX */
    int count;
    bool is_anisotropic; /* reflection depends on the light's azimuth; tables of
                            several azimuths make it so */
    bool is_isotropic;   /* the user states that it does not, against any tables */
    ImportSymmetry symmetry;
    bool black_is_zero;             /* the user states that black was subtracted */
    bool accepts_repeats;           /* the user takes means of what contradicts itself */
    const char *backlight;          /* of primaries without spectra (primary_bands.h);
                                       NULL: not stated */
    double peaks_nm[3];             /* of their bands; 0: not stated */
    const char *panel, *instrument; /* names for the manifest; NULL: the file's */
    const char *date, *operator_name, *conditions; /* of the measurement; NULL: not stated */
    ImportSpectra spectra;
    double white_apart[2]; /* of a white beside primaries (panel/set/measured.h); 0, 0: none */
    const struct LevelTable *levels;      /* of white alone (panel/set/level_table.h); NULL: none */
    const struct SpecularTable *specular; /* panel/set/specular_table.h; NULL: none */
    double specular_aperture_deg;
    double instrument_fwhm_deg;         /* 0: not stated */
    const struct Gloss *gloss;          /* in its place; NULL: none */
    const char *note[IMPORT_NOTES_MAX]; /* one line each: assumed, converted, left out */
    int note_count;
    Lines inputs; /* files that it is made from */
} ImportSet;

/* The place of a word, in any case, in a list that ends with NULL; or -1. */
int import_word_find(const char *const *list, const char *word);

ImportSet import_set(Arena *arena);

/* The first table of a source; NULL: none. */
const ImportTable *import_first(const ImportSet *set, ImportSource source);

/* Copies the table's fields (not its arrays) into the set. Refuses angles out of range, numbers
 * that are not finite, wavelengths that do not rise. */
bool import_add(ImportSet *set, const ImportTable *table, Error *err);

/* A note that stands there already is not repeated. */
void import_note(ImportSet *set, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* ---- options of the user ----------------------------------------------------------------- */

typedef struct ImportOptions {
    const char *format;             /* name of an importer; NULL: by the file itself */
    double wavelength_nm;           /* for files that state none; 0: not given */
    double area_mm[2];              /* luminous area for luminaire files; 0: the file's */
    const struct TextOptions *text; /* of text tables (text_options.h); NULL: none */
} ImportOptions;

#define IMPORT_HEAD_BYTES 4096

/* One importer: `recognises` looks at the first bytes and the name, `read` adds the tables. */
typedef struct Importer {
    const char *name;    /* for --format: "zemax", "astm", ... */
    const char *summary; /* one line for --help */
    bool (*recognises)(const char *file, const char *head, size_t head_size);
    bool (*read)(const char *file, const ImportOptions *options, ImportSet *set, Error *err);
} Importer;
