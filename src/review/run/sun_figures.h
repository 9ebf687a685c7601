/* SPDX-License-Identifier: Apache-2.0 */
/* sun_figures.h -- the case of one sight of a sweep under every sun, in figures.
 *
 * Units    verdict.h's.
 * Memory   from the arena.
 * Threads  sun_figures_judge starts its own; the same figures for any count.
 */
#pragma once
#include "review/run/sweep_probes.h"

SunFigures sun_figures_start(int count, Arena *arena);

/* Before any sun was read: names, and what hides it from the eye, of a box or ellipse from its
 * middle, which counts for every place. What must not be read passes where none of them sees
 * anything of it. */
ReviewCase sun_figures_unread(const Sweep *sweep, const Sight *sight, Arena *arena);

/* Judges the case under each of the sweep's suns, of which the sight was sampled. */
void sun_figures_judge(const Sweep *sweep, const Sight *sight, const DistantTools *tools,
                       SunFigures *figures, Arena room);

/* Steps whose suns lie apart from others'. */
typedef struct FarSteps {
    double apart_deg; /* at least */
    bool fail;        /* those that fail for sure; else whatever their verdict */
} FarSteps;

/* The worst of them; -1: none. */
int sun_figures_next(const SunFigures *figures, const SweepSuns *suns, FarSteps of,
                     const SweepSun *others, int count);

/* StepState's (suns/sweep_suns.h). */
void sun_figures_states(const SunFigures *figures, int count, unsigned char *states);
