/* SPDX-License-Identifier: Apache-2.0 */
/* cell_lights.h -- how often a guide's cells sample each set of lights, and which lamps.
 *
 * Once a cell knows from where light comes, points of it are lit by one sample of every set, as
 * paths will be. What these find, less what chance finds as well, decides. Samples of lamps,
 * drawn as where nothing is known, show what each lamp would give a point and whether its light
 * arrives; the lamps that give a cell most are kept for it.
 *
 * Threads  one cell's sums belong to one thread.
 */
#pragma once
#include "path/guiding.h"
#include "sunlit/sunlit_way.h"

#define LAMP_FINDS 16 /* lamps that a cell remembers while it is trained */

/* Sums over samples of one lamp, lx: of what it would give were nothing in the way, and of what
 * arrived. */
typedef struct LampFind {
    int id;
    double sent, arrived;
} LampFind;

typedef struct LampFinds {
    int count;
    LampFind lamp[LAMP_FINDS];
} LampFinds;

/* One more find; where there is no room, the lamp of which least arrived is forgotten, if the
 * new one gave more. */
void lamp_finds_add(LampFinds *finds, LampFind find);

/* Adds a neighbour's finds, times `weight`. */
void lamp_finds_join(LampFinds *finds, const LampFinds *neighbour, double weight);

/* The lamps of a cell in a scene of lamp_count; none where no light of any arrived. */
GuideLamps cell_lamps_keep(const LampFinds *finds, int lamp_count);

/* Sums of what light samples find at the points of a cell. */
typedef struct LightFinds {
    double sum[LIGHT_SETS], squares[LIGHT_SETS]; /* illuminances, lx */
    SunlitFinds sunlit;
    double points;
    LampFinds lamps;
} LightFinds;

/* One sample of every set for a white point of the cell that faces point.ns. */
void cell_lights_try(const PathContext *context, LitPoint point, uint32_t cell, Sampler *sampler,
                     LightFinds *finds);

/* Light of a cell, lx: as it was found, and as about it. */
typedef struct CellLight {
    double total, usual;
} CellLight;

/* Probabilities for a cell. */
void cell_lights_weigh(const PathContext *context, const LightFinds *finds, CellLight light,
                       float prob[LIGHT_CHOICES]);
