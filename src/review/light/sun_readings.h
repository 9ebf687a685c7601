/* SPDX-License-Identifier: Apache-2.0 */
/* sun_readings.h -- what a luxmeter reads under suns, kept so that none is sampled twice.
 *
 * Symbols are evaluated for suns between the steps of a year, and many for the same: a sensor
 * reads the same for all of them, the face of a display for all eyes. A reading does not depend
 * on the others that are requested beside it.
 *
 * Frame    angles as those of distant_probe.h; a sun is known by their bits and by those of its
 *          light: two dates share a direction, and differ in the earth's distance.
 * Units    lx.
 * Memory   from the arena of the start, which others may use, too: 64 to 256 bytes a sun.
 * Threads  one at a time.
 */
#pragma once
#include "review/light/setup.h"

typedef struct KeptReading {
    DistantSun sun;
    double    lux;
    bool      is_taken;
} KeptReading;

typedef struct SunReadings {
    Arena       *arena;
    KeptReading *places;
    int          count, room; /* a power of two, half of it or more free */
} SunReadings;

/* None yet. */
SunReadings sun_readings_start(Arena *arena);

/* NULL: that sun has not been read. */
const double *sun_readings_find(const SunReadings *readings, DistantSun sun);

/* The sun must not be there yet. */
void sun_readings_add(SunReadings *readings, DistantSun sun, double lux);
