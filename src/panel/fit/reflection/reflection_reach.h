/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_reach.h -- the hull of a table's directions, as panel_reach.h keeps it.
 *
 * About the rows' mean direction, with angles to it as radii, their convex hull is taken. Its
 * edges are lines there, or, where they turn by less than 60 degrees, linear in the turn: rings
 * of eight directions are round.
 * Memory   scratch. Threads: pure functions. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "panel/query/panel_file.h"
#include "panel/set/angle_table.h"

/* mirrored: directions at -phi count as those at phi. */
PanelReachStored reflection_reach(const AngleTable *table, bool mirrored, Arena scratch);

/* All directions up to an angle. */
PanelReachStored reflection_reach_cone(float theta);

/* Does it hold the cone, but for what lies between two samples of its last ring? */
bool reflection_reach_is_cone(const PanelReachStored *reach, float theta);
