/* SPDX-License-Identifier: Apache-2.0 */
/* level.h -- how bright the displays are set: fixed, or by the light on a sensor.
 *
 * Levels   multiply all that a display emits; 1: as its panel was measured.
 * Memory   the arena's of whoever read it. Threads: const data, pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>

/* A level of one display, or of all others ("*"). */
typedef struct ReviewFixedLevel {
    const char *display; /* a material's name, "node:NAME", or "*" */
    double      level;
} ReviewFixedLevel;

typedef struct ReviewLevel {
    const char       *name;
    ReviewFixedLevel *fixed;
    int               fixed_count;
    /* or, of all displays, a curve: */
    bool    is_curve;
    double  position_m[3], normal[3]; /* the sensor's, scene's frame; normal is unit */
    double *lux, *level;              /* [point_count]: lux rises, level does not fall */
    int     point_count;
} ReviewLevel;

/* A display as a review calls it, and by its material where that is another name. */
typedef struct ReviewDisplayName {
    const char *name, *material;
} ReviewDisplayName;

/* sensor_lux counts for a curve only. Of fixed levels the one by the display's own name counts
 * first, then its material's, then "*"; a display that is left out keeps `scene_level`. */
double review_level_at(const ReviewLevel *level, ReviewDisplayName display, double scene_level,
                       double sensor_lux);

/* The curve's value at an illuminance. Between two points level = a lux^b, a straight line in
 * log-log: points stand decades apart, as the eye's adaptation runs, and what makers draw on
 * such paper must not sag at a decade's beginning as a line in lux would. Where a point is at 0
 * lx or level 0 that has no logarithm, and the piece is linear. Beyond the ends: the end's. */
double review_level_of_lux(const ReviewLevel *level, double lux);
