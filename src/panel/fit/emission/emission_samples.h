/* SPDX-License-Identifier: Apache-2.0 */
/* emission_samples.h -- all tables of an emission at common directions, with what noise makes
 * of every number.
 *
 * A channel is one of X, Y, Z of one table, in the order of PanelEmission: the levels of red,
 * rising, green's, blue's, then the black pattern's.
 * Units    cd m^-2, radians. Memory: the arena's. Threads: const once gathered. Fails: never.
 */
#pragma once
#include "base/vec.h"
#include "panel/fit/common/fit_options.h"
#include "panel/query/panel_file.h"
#include "panel/set/measurement.h"

#define EMISSION_NO_LIGHT 1e-4 /* cd m^-2: what is less counts relative to this */

#define EMISSION_TABLES_MAX (3 * PANEL_LEVELS_MAX + 1)

/* Every table's totals M at the rows of the table that has the most. */
typedef struct EmissionSamples {
    const Measurement *set;
    const AngleTable *master;
    int rows, channels;
    int black; /* the black pattern's first channel, -1: none */
    Vec3 *direction;
    double *area;       /* of a row, up to a factor */
    float *total;       /* rows x channels, cd m^-2 */
    float *sigma;       /* rows x channels: what a deviation is measured in; INFINITY: unknown */
    double cone;        /* radians: the narrowest table's */
    double step_deg;    /* about how far apart neighbours are */
    int azimuths;       /* on a ring */
    double tolerance;   /* relative to M */
    double *floor;      /* channels: errors count relative to no less than this, cd m^-2 */
    double floor_share; /* of a channel's largest value that the floor is */
} EmissionSamples;

typedef struct EmissionTable {
    const AngleTable *table; /* NULL: none */
    int primary;             /* 3: black */
    int level;               /* of the primary */
    float code;              /* that level shows; 0: black */
} EmissionTable;

/* Table `index` of a set in the order of channels; has_black: the pattern is one of them. */
EmissionTable emission_samples_table(const Measurement *set, bool has_black, int index);

/* Have a table's rows no grid's order? */
bool emission_samples_are_scattered(const AngleTable *table, Arena scratch);

/* What a table's rows tell of its noise in X, Y and Z: of a grid or of scattered rows. */
typedef struct EmissionNoise {
    double relative[3];
    double dim[3];  /* where there is no light, cd m^-2 */
    bool has_edges; /* Y jumps between two samples of a grid, as no smooth lamp does. Edges look
                       like noise: the fit then takes none for it */
} EmissionNoise;

/* A value's standard deviation that the fit and its errors pardon, cd m^-2. */
double emission_noise_sigma(const EmissionNoise *noise, int channel, double value);

/* outlier: rows that show no edge. */
EmissionNoise emission_samples_noise(const AngleTable *table, const uint8_t *outlier,
                                     Arena scratch);

/* The least value that errors of a table's channel are relative to: a share of its largest
 * value in rows that outlier (NULL: none) does not mark. */
double emission_samples_floor(const AngleTable *table, int channel, const uint8_t *outlier,
                              double share);

/* outlier[table]: rows that are not to be believed; noise: of every table. In *out tolerance
 * and floor_share are given. */
void emission_samples_gather(const Measurement *set, bool has_black, uint8_t *const *outlier,
                             const EmissionNoise *noise, Arena *arena, EmissionSamples *out);

/* Notes wide gaps between azimuths, and directions without a grid's order. */
void emission_samples_note(const EmissionSamples *samples, Arena scratch, FitNotes *notes);
