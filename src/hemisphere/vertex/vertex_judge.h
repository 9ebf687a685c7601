/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_judge.h -- whether a reconstruction of a vertex is good enough for the caller.
 *
 * Threads  a judge a thread; fails never.
 */
#pragma once
#include "hemisphere/vertex/vertex_options.h"

/* Asks the caller and remembers: what lies well within a distance from the value that was
 * accepted once is taken as accepted, in any direction. The finished tree is checked without
 * that. */
typedef struct VertexJudge {
    const VertexTreeOptions *options;
    const float             *values; /* vertices x components */
    const float             *unit;   /* what an error of each component counts in, > 0 */
    float                   *safe;   /* of vertices: the largest accepted distance, in units;
                                        below 0: never taken as accepted */
    bool                     is_exact; /* does not use what it remembers */
} VertexJudge;

bool vertex_accepts(VertexJudge *judge, uint32_t vertex, const float *row);

/* The same for value + factor * (row - value). */
bool vertex_accepts_beyond(VertexJudge *judge, uint32_t vertex, const float *row, float factor);
