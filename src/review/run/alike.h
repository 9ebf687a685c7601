/* SPDX-License-Identifier: Apache-2.0 */
/* alike.h -- does a variant change what a display reflects to an eye?
 *
 * A pilot of a case and one of its variant take the same random numbers, so that a path that
 * meets nothing which was changed finds the same light. The differences path by path are a mean
 * like any other (estimate/estimate.h): the farther end of its interval, with bright ones that
 * may be missing, or what as many paths that agree may all have missed, is the most by which the
 * two are apart.
 *
 * A pilot looks at the part that the review judged, and from each of the eye's points at all of
 * the symbol, since another part or point may be the worst of the variant: a point whose paths
 * differ by more than 5 % of their light in the mean makes the two differ, too.
 *
 * Units    cd m^-2.
 * Memory   from the arena.
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "review/light/setup.h"
#include "review/symbol/symbol_surface.h"
#include "review/verdict.h"

typedef struct CasePilot CasePilot;

typedef struct PilotArgs {
    const Setup *setup;
    const SymbolSurface *surface;
    const ProbeAim *part; /* whose light counts */
    double mirror;        /* of it: the sun's image, which is known without paths */
    const Vec3 *points;   /* [point_count] of the eye */
    int point_count;
} PilotArgs;

const CasePilot *case_pilot(const PilotArgs *args, Arena *arena);

/* The most by which two are apart, 95 %, as a share of the light; INFINITY: they differ. */
double case_pilots_apart(const CasePilot *before, const CasePilot *after);
