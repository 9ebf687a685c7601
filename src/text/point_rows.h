/* SPDX-License-Identifier: Apache-2.0 */
/* point_rows.h -- points that face somewhere, from a text file: X Y Z NX NY NZ a line, as
 * Radiance's rtrace takes them.
 *
 * Blanks, tabs, commas or semicolons between numbers; # comments and empty lines allowed. A
 * header line may name the columns x, y, z, nx, ny, nz, and then gives their order.
 *
 * Units    metres; a normal may have any length but none. It comes back with the length 1.
 * Memory   the arena's.
 * Fails    with the file, the line, what was found and what is required.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

typedef struct FacingPoint {
    double place[3], normal[3];
} FacingPoint;

/* values: x, y, z, nx, ny, nz; finite. False: the normal has no direction. */
bool point_row_set(const double values[6], FacingPoint *out);

bool point_rows_read(const char *file, Arena *arena, FacingPoint **list, int *count, Error *err);
