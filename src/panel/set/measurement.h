/* measurement.h -- what a laboratory measured of one display, read and checked.
 *
 * Frame    the display's: theta from the normal, phi 0 right, 90 up; in a reflection table
 *          phi is the leaving azimuth with the light at 180, so the mirror direction is at 0.
 * Units    radians inside; XYZ with Y in cd m^-2; BRDF in sr^-1 without the cosine.
 * Memory   the arena's. Threads: const once read.
 * Fails    with file, line or JSON path, found and wanted.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "spectrum/spectral_table.h"

#define MEASUREMENT_LEVELS_MAX 64
#define MEASUREMENT_INCIDENCES_MAX 32
#define MEASUREMENT_WAVELENGTHS_MAX 256
#define MEASUREMENT_AZIMUTHS_MAX 72
#define MEASUREMENT_TABLES_MAX 1152 /* of reflection: incidences times azimuths */

/* How far below zero noise may reach: so much, or so large a share of the table's maximum. */
#define MEASUREMENT_NOISE_CD_M2 0.05f
#define MEASUREMENT_NOISE_CD_M2_SHARE 0.005f
#define MEASUREMENT_NOISE_BRDF 0.001f
#define MEASUREMENT_NOISE_BRDF_SHARE 0.001f

/* Values over directions. Rows are sorted by theta, then phi; no direction stands twice.
 * theta in [0, pi/2], phi in [0, 2 pi); rows at theta 0 have become one. */
typedef struct AngleOutlier {
    int   row; /* among those at theta 0 */
    float phi, value, expected; /* radians; Y, cd m^-2 */
} AngleOutlier;

typedef struct AngleTable {
    const char  *name;     /* "red 031", "brdf 30 deg" */
    int          rows, channels;
    const float *theta, *phi;
    const float *value;    /* rows x channels */
    size_t       text_bytes;
    float        theta_max;
    int          pole_outliers; /* of emission tables, at theta 0: they are not in the mean */
    const AngleOutlier *pole_outlier;
} AngleTable;

typedef struct MeasuredPrimary {
    int        level_count;
    double     level[MEASUREMENT_LEVELS_MAX]; /* rising, in (0, 255] */
    AngleTable table[MEASUREMENT_LEVELS_MAX]; /* XYZ, black not subtracted */
} MeasuredPrimary;

typedef struct Measurement {
    const char *file; /* the manifest */
    const char *panel, *instrument, *note;
    double      pixels[2], size_mm[2];
    double      instrument_fwhm_deg; /* width of its own response; 0: not declared */
    double      white_miss;     /* 0: Rec.709 carries every colour; else the share of the
                                   brightest one that it cannot */
    bool        is_white_only;  /* primary tables are the split of a white table */
    bool        has_black;
    AngleTable  black;
    MeasuredPrimary primary[3];
    bool        has_spectra;
    float       spectrum[3][SPECTRAL_COUNT]; /* relative, every nm from SPECTRAL_FIRST_NM */
    int         incidence_count, wavelength_count; /* 0: no reflection data */
    double      incidence[MEASUREMENT_INCIDENCES_MAX]; /* radians, rising */
    float       wavelength_nm[MEASUREMENT_WAVELENGTHS_MAX]; /* rising */
    int         azimuth_count; /* of the light; 1: isotropic, symmetric in phi */
    double      azimuth[MEASUREMENT_AZIMUTHS_MAX]; /* radians, rising, [0, 2 pi) */
    AngleTable *brdf; /* azimuth * incidence_count + incidence; channels: wavelengths */
} Measurement;

/* Reads MANIFEST.json and every table it names; a path that ends in .csv is one white-only
 * table (theta, phi and X, Y, Z or Y, x, y). Tables lie below the parent of the manifest's
 * folder. */
bool measurement_read(const char *path, Arena *arena, Measurement *out, Error *err);

/* The same; tables may also lie below `folder` (--root). NULL: no such folder. */
bool measurement_read_below(const char *path, const char *folder, Arena *arena,
                            Measurement *out, Error *err);

/* ---- one table ---------------------------------------------------------------------- */

/* Columns theta, phi and X, Y, Z (or Y, x, y), or a polar grid's three files. */
bool angle_table_read_xyz(const char *file, const char *name, Arena *arena, AngleTable *out,
                          Error *err);

/* One file a component, theta down and phi across. */
bool angle_table_read_grid(const char *const files[3], const char *name, Arena *arena,
                           AngleTable *out, Error *err);

/* Columns theta, phi and one a wavelength ("brdf" when there is but one); without a name. */
bool angle_table_read_brdf(const char *file, const float *wavelength_nm, int count,
                           Arena *arena, AngleTable *out, Error *err);
