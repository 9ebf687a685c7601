/* SPDX-License-Identifier: Apache-2.0 */
/* measured_primary.h -- the tables of one primary alone, level by level.
 *
 * Memory   its maker's. Threads: const once read.
 */
#pragma once
#include "panel/set/angle_table.h"

#define MEASUREMENT_LEVELS_MAX 64

typedef struct MeasuredPrimary {
    int        level_count;
    double     level[MEASUREMENT_LEVELS_MAX]; /* rising, in (0, 255] */
    AngleTable table[MEASUREMENT_LEVELS_MAX]; /* XYZ, black not subtracted */
} MeasuredPrimary;
