/* SPDX-License-Identifier: Apache-2.0 */
/* sweep_told.h -- what one sight of a sweep says of every sun: its case, in figures.
 *
 * Units    verdict.h's.
 * Memory   from the arena.
 * Threads  told_tell starts its own; the same figures for any count.
 */
#pragma once
#include "review/run/sweep_probes.h"

/* [sun] of each. */
typedef struct Told {
    float *contrast, *low, *high; /* with its interval */
    float *margin, *reflected, *mirror, *level, *lux;
    unsigned char *verdict, *ambient;
    int    worst; /* sun; -1: none */
} Told;

Told told_start(int count, Arena *arena);

/* The sight, asked of the sweep's suns, tells of each. */
void told_tell(const Sweep *sweep, const Sight *sight, const FarTools *tools, Told *told,
               Arena room);

bool told_is_worse(const Told *told, int sun, int than);

/* StepState's (suns/failures.h). */
void told_states(const Told *told, int count, unsigned char *states);
