/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_choose.h -- which vertices a tree stores, and towards which values; whether a
 * reconstruction of a vertex is good enough for the caller.
 *
 * Memory   scratch by value; the choice is the caller's. Threads: as many as the options allow,
 *          a judge for each.
 */
#pragma once
#include "hemisphere/tree/vertex_tree.h"

/* Calls the caller's test and remembers: what lies well within a distance from the value that
 * was accepted once is taken as accepted, in any direction. The finished tree is checked
 * without that. */
typedef struct VertexJudge {
    const VertexTreeOptions *options;
    const float *values; /* vertices x components */
    const float *unit;   /* what an error of each component counts in, > 0 */
    float *safe;         /* of vertices: the largest accepted distance, in units;
                            below 0: never taken as accepted */
    bool is_exact;       /* does not use what it remembers */
} VertexJudge;

bool vertex_accepts(VertexJudge *judge, uint32_t vertex, const float *row);

/* Vertices to store (the base's included) and the values that the tree should have. */
typedef struct VertexChoice {
    bool *chosen;  /* of vertices */
    float *target; /* vertices x components, of all vertices */
} VertexChoice;

/* Chooses few vertices, with values that are accepted everywhere with room for rounding. */
void vertex_choose(VertexJudge *judge, int base_level, Arena scratch, VertexChoice *out);
