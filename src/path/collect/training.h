/* SPDX-License-Identifier: Apache-2.0 */
/* training.h -- what a guide's training takes from paths: where they scatter, and what arrives
 * there.
 *
 * Threads  one thread's, like the path.
 */
#pragma once
#include "path/path_collector.h"

#define PATH_PLACES_MAX 8

/* Where a path scattered widely: just off the surfaces, on the side that was looked at. */
typedef struct PathPlaces {
    int count;
    LitPoint place[PATH_PLACES_MAX];
} PathPlaces;

typedef struct TrainingPlaces {
    PathCollector base;
    PathPlaces *out;
} TrainingPlaces;

/* The context must have a guide, trained or not. */
TrainingPlaces training_places(PathPlaces *out);

/* Keeps the luminance, cd m^-2, of the sky that a path to a point (PathStart.from) sees
 * straight from there; 0: none. The path's own light is all other, and ends at the second
 * surface that scatters widely: a training pass, no measurement. */
typedef struct TrainingSky {
    PathCollector base;
    float *sky_cd_m2;
    int wide; /* surfaces so far that scatter widely */
} TrainingSky;

TrainingSky training_sky(float *sky_cd_m2);
