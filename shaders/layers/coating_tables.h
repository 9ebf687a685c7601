/* SPDX-License-Identifier: Apache-2.0 */
/* coating_tables.h -- makes the tables of coated boundaries (coating.h) of their layers.
 *
 * Light is taken as unpolarised at each boundary, but for the faces of sheets and panes, which
 * have tables for each polarisation.
 *
 * stack: NULL is a bare boundary in air. ior: absolute index of glass or plastic, 1 or more.
 * Memory   from the arena (coating.h).  Threads  any.  Fails  never. A table takes some tens of
 *          milliseconds, energies of every alpha a fifth of a second.
 */
#pragma once
#include "shaders/layers/coating.h"
#include "spectrum/glazing.h"

/* The boundary of a closed solid. */
const CoatingTables *coating_of_solid(const LayerStack *stack, double ior, Arena *arena);

/* The faces of a sheet in the medium outside, for both polarisations; stack->faces: those that
 * are coated. */
const PaneCoating *coating_of_sheet(const LayerStack *stack, double ior, Arena *arena);

/* A metal seen from outside: front alone. */
const CoatingTables *coating_of_metal(const LayerStack *stack, const OpticalConstants *metal,
                                      Arena *arena);

/* The alphas that a boundary is queried at, in [0, 1]. */
typedef struct AlphaSpan {
    float least, most;
} AlphaSpan;

#define ALPHA_ALL (AlphaSpan){0, 1}

/* The boundary of an opaque body seen from outside: front alone, with its energies of `alphas`;
 * of others they are 0 and must not be queried. */
const CoatingTables *coating_of_face(const LayerStack *stack, double ior, AlphaSpan alphas,
                                     Arena *arena);

/* The boundary of a metal or, where that is NULL, of a body of index ior: polarised light. */
const CoatingWaves *coating_waves(const LayerStack *stack, double ior,
                                  const OpticalConstants *metal, Arena *arena);

/* Reflectance of a display's coated cover over that of its bare glass: front alone; as no
 * share of light it may be above 1. */
const CoatingTables *coating_of_cover(const LayerStack *stack, double ior, Arena *arena);

/* The faces of a laminated pane in air (Glazing: its outermost layers, its coatings, NULL where
 * a face is bare), for both polarisations. */
const PaneCoating *coating_of_pane(const Glazing *pane, Arena *arena);
