/* SPDX-License-Identifier: Apache-2.0 */
/* angle_table.h -- one measured table: values over directions, read from text and checked.
 *
 * Frame    the display's: theta from the normal, phi 0 right, 90 up.
 * Units    radians inside, degrees in files; XYZ with Y in cd m^-2, or BRDF in sr^-1.
 * Memory   the arena's. Threads: const once read.
 * Fails    with file, line, found and required.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

/* How far below zero noise may reach: so much, or so large a share of the table's maximum. */
#define ANGLE_TABLE_NOISE_CD_M2 0.05f
#define ANGLE_TABLE_NOISE_CD_M2_SHARE 0.005f
#define ANGLE_TABLE_NOISE_BRDF 0.001f
#define ANGLE_TABLE_NOISE_BRDF_SHARE 0.001f

/* A row that is left out of the mean at theta 0. */
typedef struct AngleOutlier {
    int row;                    /* among those at theta 0 */
    float phi, value, expected; /* radians; Y, cd m^-2 */
} AngleOutlier;

/* Values over directions. Rows are sorted by theta, then phi; no direction stands twice.
 * theta in [0, pi/2], phi in [0, 2 pi); rows at theta 0 have become one. */
typedef struct AngleTable {
    const char *name; /* "red 031", "brdf 30 deg" */
    int rows, channels;
    const float *theta, *phi;
    const float *value; /* rows x channels */
    size_t text_bytes;
    float theta_max;
    int pole_outliers; /* of emission tables, at theta 0: they are not in the mean */
    const AngleOutlier *pole_outlier;
} AngleTable;

/* Columns theta, phi and X, Y, Z (or Y, x, y). */
bool angle_table_read_xyz(const char *file, const char *name, Arena *arena, AngleTable *out,
                          Error *err);

/* Columns theta, phi and one a wavelength ("brdf" when there is but one); without a name. */
bool angle_table_read_brdf(const char *file, const float *wavelength_nm, int count, Arena *arena,
                           AngleTable *out, Error *err);

/* True when both tables have the same directions. */
bool angle_table_same_rows(const AngleTable *a, const AngleTable *b);

/* "red", "green", "blue". */
extern const char *const primary_names[3];

/* The tables of one primary alone, level by level. */
#define MEASUREMENT_LEVELS_MAX 64

typedef struct MeasuredPrimary {
    int level_count;
    double level[MEASUREMENT_LEVELS_MAX];     /* rising, in (0, 255] */
    AngleTable table[MEASUREMENT_LEVELS_MAX]; /* XYZ, black not subtracted */
} MeasuredPrimary;
