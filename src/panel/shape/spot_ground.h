/* SPDX-License-Identifier: Apache-2.0 */
/* spot_ground.h -- how much each of some places counts at a place between them.
 *
 * Places on a whole grid (every column with every row, evenly spaced or not) count bilinearly;
 * others by the triangles of Delaunay's triangulation, linearly in each. Outside of all places
 * the nearest point on their border counts. Weights are never negative, add up to one and have
 * no jumps; a place's own weight there is one.
 *
 * Frame    the active area: u from 0 at the left to 1 at the right, v from 0 at the top to 1 at
 *          the bottom, as someone facing the display sees it.
 * Memory   the arena's. Threads: const once built. HOT: spot_ground_weights.
 * Source   B. Delaunay, Sur la sphere vide (1934); as the lower hull of the places lifted onto
 *          a paraboloid: K. Q. Brown, Voronoi diagrams from convex hulls (1979).
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"

#define SPOT_GROUND_MAX 49  /* places */
#define SPOT_GROUND_COUNT 4 /* that count at once */

typedef struct SpotGround {
    int count;
    const float (*at)[2];
    int columns, rows;                            /* 0: no grid */
    float u[SPOT_GROUND_MAX], v[SPOT_GROUND_MAX]; /* rising */
    uint8_t of_cell[SPOT_GROUND_MAX];             /* row * columns + column */
    int triangles, edges;
    uint8_t (*triangle)[3];
    uint8_t (*edge)[2]; /* the border; of places on one line the pieces between them */
} SpotGround;

/* Which places count at a place, and how much. */
typedef struct SpotWeights {
    int count;
    int spot[SPOT_GROUND_COUNT];
    float weight[SPOT_GROUND_COUNT];
} SpotWeights;

/* at: 1 to SPOT_GROUND_MAX different places, which must outlive the ground. */
void spot_ground_build(const float (*at)[2], int count, Arena *arena, SpotGround *out);

/* HOT. place: held inside the active area. */
SpotWeights spot_ground_weights(const SpotGround *ground, const float place[2]);
