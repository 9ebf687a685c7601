/* SPDX-License-Identifier: Apache-2.0 */
/* field.h -- a quantity over the hemisphere as a square grid of the polar map, and its lines.
 *
 * Frame    the map is a disc: theta grows evenly from its centre, phi counter-clockwise from
 *          the right as one sees the display. Grid row 0 is the top. Cells outside the disc
 *          hold the value at the rim, so that contour lines run cleanly through it.
 * Units    radians; values in their own unit, NaN where there is none.
 * Memory   the arena's. Threads: const once filled.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "base/vec.h"

typedef struct Field {
    int side;         /* odd: the centre is a grid point */
    double theta_rim; /* at the disc's edge */
    float *value;     /* side x side */
} Field;

/* All NaN. */
Field field_new(int side, double theta_rim, Arena *arena);

/* The direction of a grid point; theta is cut off just above the surface. */
Vec3 field_direction(const Field *field, int row, int column);

/* theta and phi (radians) to grid coordinates. */
void field_place(const Field *field, double theta, double phi, double *column, double *row);

/* Bilinear at grid coordinates, which are cut off at the edges. */
double field_at(const Field *field, double column, double row);

typedef struct FieldRange {
    double low, high;  /* over directions inside the disc, finite values only */
    double theta, phi; /* of the highest, radians */
} FieldRange;

/* The value that `share` of the disc's area inside theta_limit stays below. */
double field_quantile(const Field *field, double theta_limit, double share, Arena scratch);

/* theta_limit: only directions below it count. All NaN: low and high are 0. */
FieldRange field_range(const Field *field, double theta_limit);

/* ---- lines of equal value, by marching squares ---------------------------------------------
 *
 * Frame    grid units: x to the right 0 .. side - 1, y DOWN 0 .. side - 1 (row 0 on top). */

typedef struct ContourPoint {
    double x, y;
} ContourPoint;

typedef struct ContourLine {
    int count;
    bool is_closed; /* the last point is the first one again */
    ContourPoint *point;
} ContourLine;

typedef struct ContourSet {
    int count;
    ContourLine *line;
} ContourSet;

/* value: side x side, row by row. A cell with a value that is not finite has no line.
 * Crossings are interpolated linearly along the cell's edge. */
ContourSet contour_lines(const float *value, int side, double level, Arena *arena);
