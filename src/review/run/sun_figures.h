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

/* Judges the case under each of the sweep's suns, of which the sight was asked. */
void sun_figures_judge(const Sweep *sweep, const Sight *sight, const DistantTools *tools,
                       SunFigures *figures, Arena room);

bool sun_figures_is_worse(const SunFigures *figures, int sun, int than);

/* StepState's (suns/failures.h). */
void sun_figures_states(const SunFigures *figures, int count, unsigned char *states);
