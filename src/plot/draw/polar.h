/* SPDX-License-Identifier: Apache-2.0 */
/* polar.h -- the polar map: colours, lines of equal value with their numbers, angles, a scale.
 *
 * Units    angles in radians inside, lettered in degrees; the field's values in their own unit.
 * Threads  one thread a canvas.
 */
#pragma once
#include "plot/draw/canvas.h"
#include "plot/draw/colour_map.h"
#include "plot/draw/field.h"

#define POLAR_LEVELS_MAX 24

typedef struct PolarMap {
    const Field *field;
    ColourMap map;
    double low, high; /* of the colours */
    bool is_log;
    bool is_cut; /* values above `high` have its colour: the scale has an arrow */
    int level_count;
    double level[POLAR_LEVELS_MAX];           /* of the lines */
    const char *level_text[POLAR_LEVELS_MAX]; /* NULL: the number itself */
    double step;   /* between levels, for their labels; 0: figures as they are */
    double strong; /* a level drawn strongly, NaN: none */
    const char *strong_text;
    double theta_measured; /* beyond it: hatched */
    const Field *measured; /* hatched where it is 0, too; NULL: nowhere */
    const char *unit;      /* above the scale */
    bool has_light;        /* marks the light at theta_light, phi 180 */
    double theta_light;
    bool is_residual; /* no lines: values are scattered */
} PolarMap;

/* Where the disc came to lie, for read-outs. */
typedef struct PolarPlace {
    double x, y, radius;
} PolarPlace;

PolarPlace polar_draw(Canvas *canvas, Box box, const PolarMap *map);
