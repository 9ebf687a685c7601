/* SPDX-License-Identifier: Apache-2.0 */
/* polarised_rows.h -- a path whose light counts by how it is polarised (path/polarised.h).
 *
 * Units    Stokes parameters: luminances, cd m^-2.
 * Threads  one thread's, like the path.
 */
#pragma once
#include "path/path_collector.h"

typedef struct PolarisedRows {
    PathCollector       base;
    const PolarisedEye *eye;
    Polarised           light;
    float              *stokes; /* S0 to S3 that analysers find besides, added to; NULL: none */
} PolarisedRows;

PolarisedRows polarised_rows(const PolarisedEye *eye, float *stokes, PathCollector *next);
