/* SPDX-License-Identifier: Apache-2.0 */
/* polar.h -- the polar map: colours, lines of equal value with their numbers, angles, a scale.
 *
 * Units    angles in radians inside, lettered in degrees; the field's values in their own unit.
 * Threads  one thread a canvas.
 */
#pragma once
#include "plot/draw/polar_disc.h"

/* Where the disc came to lie, for read-outs. */
typedef struct PolarPlace {
    double x, y, radius;
} PolarPlace;

PolarPlace polar_draw(Canvas *canvas, Box box, const PolarMap *map);
