/* SPDX-License-Identifier: Apache-2.0 */
/* table_rows.h -- where the rows of a measured table lie, and next to which others.
 *
 * Rows are sorted by theta, then phi; a ring is the rows of one theta. Angles in radians.
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include "base/vec.h"
#include "panel/set/angle_table.h"

Vec3 table_direction(double theta, double phi);
Vec3 table_row_direction(const AngleTable *table, int row);

/* A row's share of the hemisphere times its cosine, up to a factor: rings and azimuths are
 * about even. */
double table_row_weight(const AngleTable *table, int row);

/* The first row behind the ring that begins at a row. */
int table_ring_end(const AngleTable *table, int begin);

/* Per row: the one before it on its ring, and the one at the same azimuth on the ring inside;
 * -1: none, or too far (13 degrees on the ring). */
typedef struct TableNeighbours {
    const int *ring, *inner;
} TableNeighbours;
TableNeighbours table_neighbours(const AngleTable *table, Arena *arena);
