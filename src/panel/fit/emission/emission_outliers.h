/* SPDX-License-Identifier: Apache-2.0 */
/* emission_outliers.h -- rows of an emission table that stand out of their neighbourhood (hot
 * and dead pixels), and directions that its grid lacks (the shadow of what holds the source).
 *
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include <stdint.h>

#include "panel/set/angle_table.h"

/* A direction of a table that stands out, or is missing. */
typedef struct EmissionFlag {
    const char *table;
    double theta, phi;      /* radians */
    double value, expected; /* Y, cd m^-2 */
} EmissionFlag;

#define EMISSION_FLAGS_MAX 4096
typedef struct EmissionFlags {
    EmissionFlag *flag; /* room for EMISSION_FLAGS_MAX */
    int count;          /* may be more than are listed */
} EmissionFlags;

/* Rows of an XYZ table that no neighbour explains: is_outlier[row]. Returns how many. */
int emission_outliers_find(const AngleTable *table, uint8_t *is_outlier, EmissionFlags *flags,
                           Arena scratch);

/* Directions that the table's grid lacks. Returns how many. */
int emission_outliers_find_holes(const AngleTable *table, EmissionFlags *flags, Arena scratch);
