/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_choose.h -- which vertices a tree stores, and towards which values.
 *
 * Memory   scratch by value; the choice is the caller's. Threads: as many as the options allow.
 */
#pragma once
#include "hemisphere/vertex/vertex_judge.h"

/* Vertices to store (the base's included) and the values that the tree should have. */
typedef struct VertexChoice {
    bool  *chosen; /* of vertices */
    float *target; /* vertices x components, of all vertices */
} VertexChoice;

/* Chooses few vertices, with values that are accepted everywhere with room for rounding. */
void vertex_choose(VertexJudge *judge, int base_level, Arena scratch, VertexChoice *out);
