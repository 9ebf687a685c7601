/* SPDX-License-Identifier: Apache-2.0 */
/* white_split.h -- a set of white alone as primaries, at full level or at a gamma table's.
 *
 * White's XYZ at each angle is split into non-negative amounts of the Rec.709 primaries, or,
 * where those cannot carry the table, into constant shares of its own colour. With a table of
 * levels (level_table.h), w(d) white's XYZ and w_p(d) the part of primary p:
 *   black(d)  = b w(d)                              b = black_share
 *   M_p(g, d) = black(d) + (1 - b) w_p(d) share_p(g)
 * An approximation: real panels change their angular shape with the level. White stays w(d).
 *
 * Units    XYZ with Y in cd m^-2. Memory: the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "panel/set/level_table.h"
#include "panel/set/angle_table.h"

/* levels: NULL for full level alone and no black, whose `rows` are then 0. Returns 0 where
 * Rec.709 carries every colour, else the share of the brightest one that it cannot. */
double white_split(const AngleTable *white, const LevelTable *levels, Arena *arena,
                   MeasuredPrimary primary[3], AngleTable *black);
