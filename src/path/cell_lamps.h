/* SPDX-License-Identifier: Apache-2.0 */
/* cell_lamps.h -- which lamps light a guide's cell, and how much of each one's light arrives.
 *
 * Samples of lamps, drawn as where nothing is known, show what each lamp would give a point and
 * whether its light arrives; the lamps that give a cell most are kept for it.
 *
 * Threads  plain values.
 */
#pragma once
#include "guide/guide.h"

#define LAMP_FINDS 16 /* lamps that a cell remembers while it learns */

/* Sums over samples of one lamp, lx: of what it would give were nothing in the way, and of what
 * arrived. */
typedef struct LampFind {
    int    id;
    double sent, arrived;
} LampFind;

typedef struct LampFinds {
    int      count;
    LampFind lamp[LAMP_FINDS];
} LampFinds;

/* One more find; where there is no room, the lamp of which least arrived is forgotten, if the
 * new one gave more. */
void lamp_finds_add(LampFinds *finds, LampFind find);

/* Adds a neighbour's finds, times `weight`. */
void lamp_finds_join(LampFinds *finds, const LampFinds *neighbour, double weight);

/* The lamps of a cell in a scene of lamp_count; none where no light of any arrived. */
GuideLamps cell_lamps_keep(const LampFinds *finds, int lamp_count);
