/* SPDX-License-Identifier: Apache-2.0 */
/* emission_values.h -- values at the vertices of a lattice by least squares: what the smooth
 * part leaves of an emission's scores, as smooth as their noise requires.
 *
 * Threads  pure functions. Fails: on numbers that are not finite (ERROR_INPUT).
 */
#pragma once
#include "hemisphere/vertex/vertex.h"
#include "panel/fit/emission/emission_model.h"

typedef struct EmissionValues {
    const EmissionModel *model;
    const Geodesic      *geodesic;
    VertexLattice        lattice;
    uint32_t             vertices;
    float               *value; /* vertices x components */
} EmissionValues;

/* One component of all values; rest: rows x components. */
bool emission_values_fit(const EmissionValues *values, const float *rest, int component,
                         Arena scratch, Error *err);
