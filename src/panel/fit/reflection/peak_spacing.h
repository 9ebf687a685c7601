/* SPDX-License-Identifier: Apache-2.0 */
/* peak_spacing.h -- how far apart a table's rows are around the mirror direction.
 *
 * Units    radians. Memory: scratch. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/set/angle_table.h"

typedef struct PeakSpacing {
    double theta;  /* between rings */
    double across; /* between azimuths, along the ring: times the sine of theta */
    double widest; /* the larger of both: narrower things are not seen by every row */
} PeakSpacing;

PeakSpacing peak_spacing_find(const AngleTable *table, double incidence, Arena scratch);
