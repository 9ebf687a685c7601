/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_fit.h -- values at the vertices of a lattice from samples anywhere.
 *
 * Memory   the caller's scratch. Threads: pure functions.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/vertex/vertex.h"

typedef struct VertexSamples {
    int count, components;
    const Vec3 *direction;
    const float *value;  /* count x components */
    const float *weight; /* count, >= 0; NULL: all 1 */
} VertexSamples;

/* Vertex values (vertex_count x components) whose linear interpolation fits the samples best:
 * least squares with the penalty ridge * 16^i * detail^2 on the details of level i = 1, 2, ...
 * (the value of a new vertex less the mean of its edge's ends; of the four corners on the
 * horizon, i = 0, less the pole), relative to the samples' total weight. What no sample reaches
 * stays smooth. Solved by conjugate gradients over the details, for all components at once.
 * Fails (ERROR_INPUT) on numbers that are not finite and when no sample has a weight. */
bool vertex_fit(VertexLattice lattice, const VertexSamples *samples, double ridge, Arena *scratch,
                float *values, Error *err);
