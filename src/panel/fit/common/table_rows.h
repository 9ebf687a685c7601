/* SPDX-License-Identifier: Apache-2.0 */
/* table_rows.h -- where the rows of a measured table lie, next to which others, and how
 * noisy it is.
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

/* ---- noise, estimated from a table alone --------------------------------------------------
 *
 * Smooth data leave nearly nothing of high differences of neighbours; noise of standard
 * deviation s leaves s sqrt(sum of squared binomials), so the median of their sizes over that
 * root and over a normal distribution's median is s. Structure only adds to a difference:
 * the least over orders 3, 5 and 7, rings and meridians, values and logarithms is taken. 0 when
 * fewer than 16 differences can be had. */

/* Noise of a channel, relative to its values, inside 70 degrees. */
double table_noise_relative(const AngleTable *table, int channel, Arena scratch);

/* In the channel's unit on the dimmest rings (the last tenth of theta), where only what does
 * not scale with light is left. */
double table_noise_dim(const AngleTable *table, int channel, Arena scratch);

/* In the channel's unit over all rows. */
double table_noise_plain(const AngleTable *table, int channel, Arena scratch);
