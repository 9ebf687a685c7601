/* SPDX-License-Identifier: Apache-2.0 */
/* contour.h -- lines of equal value of a function on a square grid, by marching squares.
 *
 * Frame    grid units: x to the right 0 .. side - 1, y DOWN 0 .. side - 1 (row 0 on top).
 * Memory   the arena's. Threads: pure functions.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"

typedef struct ContourPoint {
    double x, y;
} ContourPoint;

typedef struct ContourLine {
    int           count;
    bool          is_closed; /* the last point is the first one again */
    ContourPoint *point;
} ContourLine;

typedef struct ContourSet {
    int          count;
    ContourLine *line;
} ContourSet;

/* value: side x side, row by row. A cell with a value that is not finite has no line.
 * Crossings are interpolated linearly along the cell's edge. */
ContourSet contour_lines(const float *value, int side, double level, Arena *arena);
